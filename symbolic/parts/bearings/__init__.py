"""Rolling bearings: elements that pass one after another between two wavy races."""
