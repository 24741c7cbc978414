// A quarter of a tube, 10 < r < 20; mm
a = 10; b = 20; h = 6;
Point(1) = {0, 0, 0}; Point(2) = {a, 0, 0, h}; Point(3) = {b, 0, 0, h}; Point(4) = {0, b, 0, h}; Point(5) = {0, a, 0, h};
Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5}; Circle(4) = {5, 1, 2};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Physical Curve("x") = {1}; Physical Curve("rim") = {2}; Physical Curve("y") = {3}; Physical Curve("bore") = {4};
Physical Surface("tube") = {1};
