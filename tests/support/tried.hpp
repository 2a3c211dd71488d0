// How often a misfortune was tried: rows of the table in docs/reliability.md, printed by the tests that earn them.
#pragma once

#include <cstdint>
#include <string>

namespace grainsweep::tests {

/// Prints a row of Markdown: what was tried, how often, and how often what must hold did; without the last, every time
/// (a test that fails says so itself).
void tried(const std::string& what, std::int64_t times);
void tried(const std::string& what, std::int64_t times, std::int64_t held);

}  // namespace grainsweep::tests
