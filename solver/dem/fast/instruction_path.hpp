// Choice of vector instructions: the kernels are compiled once for each path, and each engine uses one path.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/dem/fast/layout.hpp"

namespace grainsweep::dem::fast {

/// Returns whether this processor can run a path; true for `best` if it can run any.
[[nodiscard]] bool supports(Method::Path path);
/// Returns the path that `best` means in this process: the widest one of the processor, unless prefer() has set
/// another.
[[nodiscard]] Method::Path best_path();
/// Sets the path that `best` means; it must be supported. For tests and benchmarks of narrower paths. Existing engines
/// keep their path.
void prefer(Method::Path path);

/// Returns the kernels of a path (not `best`) for the needs of a case.
[[nodiscard]] const Kernels& kernels_of(Method::Path path, const Needs& needs);

}  // namespace grainsweep::dem::fast
