// Files that are compiled into the program byte for byte, so that it needs none at run time: the assembler copies a
// file between two labels.
#pragma once

#include <cstddef>
#include <string_view>

/// At namespace scope, once in the program: afterwards GRAINSWEEP_EMBEDDED(name) is the file's contents.
#define GRAINSWEEP_EMBED(name, file)                   \
    __asm__(                                           \
        ".pushsection .rodata\n"                       \
        ".global grainsweep_" #name                    \
        "_begin\n"                                     \
        ".global grainsweep_" #name                    \
        "_end\n"                                       \
        "grainsweep_" #name                            \
        "_begin:\n"                                    \
        ".incbin \"" file                              \
        "\"\n"                                         \
        "grainsweep_" #name                            \
        "_end:\n"                                      \
        ".byte 0\n"                                    \
        ".popsection\n");                              \
    extern "C" const char grainsweep_##name##_begin[]; \
    extern "C" const char grainsweep_##name##_end[]

#define GRAINSWEEP_EMBEDDED(name)               \
    std::string_view(grainsweep_##name##_begin, \
                     static_cast<std::size_t>(grainsweep_##name##_end - grainsweep_##name##_begin))
