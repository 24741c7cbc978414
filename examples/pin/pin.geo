// Half of a pin of radius 9.99 in half of a hole of radius 10 in a round plate of radius 200, touching at (0, -10); mm
// The force enters the pin at a small hole about its centre.
R = 10; dR = 0.01; r = 0.5; far = 200; near = 1.2;
Point(1) = {0, -dR, 0}; Point(2) = {0, -R, 0, near}; Point(3) = {R - dR, -dR, 0, near}; Point(4) = {0, R - 2 * dR, 0, 2 * near};
Point(5) = {0, -r - dR, 0, r / 3}; Point(6) = {r, -dR, 0, r / 3}; Point(7) = {0, r - dR, 0, r / 3};
Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 7}; Circle(4) = {7, 1, 6}; Circle(5) = {6, 1, 5}; Line(6) = {5, 2};
Curve Loop(1) = {1, 2, 3, 4, 5, 6}; Plane Surface(1) = {1};
Point(11) = {0, 0, 0}; Point(12) = {0, -R, 0, near}; Point(13) = {R, 0, 0, near}; Point(14) = {0, R, 0, 2 * near};
Point(15) = {0, far, 0, far / 4}; Point(16) = {far, 0, 0, far / 4}; Point(17) = {0, -far, 0, far / 4};
Circle(11) = {14, 11, 13}; Circle(12) = {13, 11, 12}; Line(13) = {12, 17}; Circle(14) = {17, 11, 16}; Circle(15) = {16, 11, 15};
Line(16) = {15, 14};
Curve Loop(2) = {11, 12, 13, 14, 15, 16}; Plane Surface(2) = {2};
Physical Curve("pin") = {1, 2}; Physical Curve("core") = {4, 5}; Physical Curve("middle") = {3, 6};
Physical Curve("hole") = {11, 12}; Physical Curve("rim") = {14, 15}; Physical Curve("axis") = {13, 16};
Physical Surface("pin") = {1}; Physical Surface("plate") = {2};
