"""A scene from geometry that was drawn elsewhere: the curves of a drawing become beams."""
