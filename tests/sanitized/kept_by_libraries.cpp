// What libraries keep until the process ends is no leak. The address sanitizer asks here for their names: fontconfig
// has a few objects, as many after one figure as after many.
extern "C" const char* __lsan_default_suppressions();

extern "C" const char* __lsan_default_suppressions() {
    return "leak:libfontconfig\n";
}
