// Patches have no vertices: patch.tesc reads the records.
#version 450
void main() {}
