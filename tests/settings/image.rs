//! The same on the image.
