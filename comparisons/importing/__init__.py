"""A scene from geometry that was drawn elsewhere: the tagged curves of a file that gmsh reads become beams."""
