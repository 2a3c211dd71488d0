// Facts about this executable and its machine.
#pragma once

#include "sweep/store/store.hpp"

#include <string>

namespace grainsweep::cli {

/// Returns the version without the commit.
[[nodiscard]] std::string program_version();
/// Returns version and commit; "-modified" marks a modified source tree.
[[nodiscard]] std::string build_version();
/// Returns the id of this executable, hexadecimal, made by the linker: equal for equal machine code.
[[nodiscard]] std::string build_id();
/// Returns the program and machine of this process.
[[nodiscard]] campaign::Computer this_computer();
/// Returns version, commit, compiler, flags, instruction path, processor and host of this process.
[[nodiscard]] store::Provenance provenance();
/// Returns the output of --version.
[[nodiscard]] std::string version_text();

}  // namespace grainsweep::cli
