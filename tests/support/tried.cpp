#include "tests/support/tried.hpp"

#include <cstdio>

namespace grainsweep::tests {

void tried(const std::string& what, std::int64_t times) {
    tried(what, times, times);
}

void tried(const std::string& what, std::int64_t times, std::int64_t held) {
    std::printf("| %s | %lld | %lld |\n", what.c_str(), static_cast<long long>(times), static_cast<long long>(held));
    std::fflush(stdout);
}

}  // namespace grainsweep::tests
