// A fragment of a box, which is only tested against the depths of the target.
void main() {}
