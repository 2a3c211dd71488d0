// Disk full, database locked or damaged: nothing the question can do about it. Exit code 3.
#pragma once

#include <stdexcept>

namespace grainsweep {

class BrokenWorld : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace grainsweep
