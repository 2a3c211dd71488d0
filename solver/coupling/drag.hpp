// Drag laws: the factor f by which the drag of a sphere exceeds Stokes' 6 pi mu R |u - V|.
#pragma once

#include <cmath>

namespace grainsweep::coupling {

/// f = 1, Re_p << 1.
struct StokesDrag {
    [[nodiscard]] static double factor(double /*reynolds*/) { return 1; }
};

/// f = 1 + 0.15 Re_p^0.687, Re_p < 800 (Schiller & Naumann 1933; Clift, Grace & Weber 1978, table 5.1).
struct SchillerNaumann {
    [[nodiscard]] static double factor(double reynolds) {
        return reynolds > 0 ? 1 + 0.15 * std::exp(0.687 * std::log(reynolds)) : 1;
    }
};

}  // namespace grainsweep::coupling
