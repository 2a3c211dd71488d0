// Which vector instructions a process uses: the kernels are compiled once for each path, chosen once per engine.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/dem/fast/layout.hpp"

namespace grainsweep::dem::fast {

/// Whether this processor can run a path; `best` always.
[[nodiscard]] bool supports(Method::Path path);
/// What `best` means in this process: the widest path the processor has, unless prefer said otherwise.
[[nodiscard]] Method::Path best_path();
/// From now on `best` means this path, which must be supported. For tests and benchmarks of the narrower ones; engines
/// that exist keep theirs.
void prefer(Method::Path path);

/// The kernels of a path (not `best`) for what a case needs.
[[nodiscard]] const Kernels& kernels_of(Method::Path path, const Needs& needs);

}  // namespace grainsweep::dem::fast
