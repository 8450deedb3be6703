"""The public interface as it was last written down."""
