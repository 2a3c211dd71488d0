#include "tests/support/places.hpp"

namespace grainsweep::tests {

std::filesystem::path source(const std::string& part) {
    const std::filesystem::path root = GRAINSWEEP_SOURCE;
    return part.empty() ? root : root / part;
}

std::filesystem::path executable() {
    return GRAINSWEEP_EXECUTABLE;
}

std::filesystem::path failing_calls() {
    return GRAINSWEEP_FAILING_CALLS;
}

std::filesystem::path reference(const std::string& part) {
    return source("tests/reference") / part;
}

}  // namespace grainsweep::tests
