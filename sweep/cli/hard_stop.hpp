// An end to what cannot be asked to end: one function of SQLite may work for hours between two looks at the clock.
#pragma once

#include <string>

namespace grainsweep::cli {

/// While it lives, the program ends with exit code 2 and the sentence once it has taken so much processor time; 0:
/// never. Meant to come after a gentler limit of the same time.
class HardStop {
public:
    HardStop(double seconds, const std::string& sentence);
    HardStop(const HardStop&) = delete;
    HardStop& operator=(const HardStop&) = delete;
    ~HardStop();
};

}  // namespace grainsweep::cli
