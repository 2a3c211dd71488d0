// What this executable is and where it runs.
#pragma once

#include "sweep/store/store.hpp"

#include <string>

namespace grainsweep::cli {

/// Version, without the commit.
[[nodiscard]] std::string program_version();
/// Version and commit; "-modified" marks a tree with changes of its own.
[[nodiscard]] std::string build_version();
/// Id of this executable, hexadecimal, put there by the linker: equal for equal machine code.
[[nodiscard]] std::string build_id();
/// This process as one that computes.
[[nodiscard]] campaign::Computer this_computer();
/// Version, commit, compiler, flags, instruction path, processor and host of this process.
[[nodiscard]] store::Provenance provenance();
/// What --version prints: a line each.
[[nodiscard]] std::string version_text();

}  // namespace grainsweep::cli
