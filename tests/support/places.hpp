// Where the tests find the repository, the program and the reference data.
#pragma once

#include <filesystem>
#include <string>

namespace grainsweep::tests {

/// A file or folder of the repository, e.g. "configs"; without an argument its root.
[[nodiscard]] std::filesystem::path source(const std::string& part = {});

/// The program under test.
[[nodiscard]] std::filesystem::path executable();

/// The library that makes one of its system calls go wrong.
[[nodiscard]] std::filesystem::path failing_calls();

/// A file of tests/reference (numbers made by other programs), e.g. "designs/halton_plain.csv".
[[nodiscard]] std::filesystem::path reference(const std::string& part);

}  // namespace grainsweep::tests
