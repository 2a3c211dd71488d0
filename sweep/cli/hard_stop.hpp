// Forced end of a computation that cannot be interrupted: a function of SQLite may run for hours between two checks of
// the time.
#pragma once

#include <string>

namespace grainsweep::cli {

/// Guard that ends the program with exit code 2 and the sentence after this processor time; 0: never. It backs up a
/// softer limit of the same time.
class HardStop {
public:
    HardStop(double seconds, const std::string& sentence);
    HardStop(const HardStop&) = delete;
    HardStop& operator=(const HardStop&) = delete;
    ~HardStop();
};

}  // namespace grainsweep::cli
