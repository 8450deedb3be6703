"""A branch as a page to play with: one self-contained HTML file, without a server or a network."""
