"""What the reports share: sections, computed one by one and kept, and the page put together from them."""
