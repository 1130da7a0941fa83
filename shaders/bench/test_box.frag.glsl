// A fragment of a box that is only tested against the depths that are there.
void main() {}
