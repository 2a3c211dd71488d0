// Error of the environment, independent of the user's input: disk full, database locked or damaged. Exit code 3.
#pragma once

#include <stdexcept>

namespace grainsweep {

class SystemError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace grainsweep
