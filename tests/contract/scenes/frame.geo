// One line, in mm, tagged as a beam.
Point(1) = {0, 0, 0};
Point(2) = {100, 0, 0};
Line(1) = {1, 2};
Physical Curve("beam") = {1};
