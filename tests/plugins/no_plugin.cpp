// A shared library that has nothing to do with drev.
extern "C" int answer() { return 42; }
