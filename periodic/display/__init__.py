"""What a notebook or a terminal shows: tables, small pictures, how far something is."""
