// Drag laws: the ratio f of a sphere's drag to Stokes' drag 6 pi mu R |u - V|.
#pragma once

#include "solver/coupling/elementary.hpp"

namespace grainsweep::coupling {

/// f = 1, Re_p << 1.
struct StokesDrag {
    [[nodiscard, gnu::always_inline]] static double factor(double /*reynolds*/) { return 1; }
};

/// f = 1 + 0.15 Re_p^0.687, Re_p < 800 (Schiller & Naumann 1933; Clift, Grace & Weber 1978, table 5.1).
struct SchillerNaumann {
    [[nodiscard, gnu::always_inline]] static double factor(double reynolds) {
        constexpr double least = 1e-300;  // f is 1 there, and the logarithm needs normal numbers
        const double power = exponential(0.687 * logarithm(reynolds > least ? reynolds : least)).value();
        return 1 + 0.15 * power;
    }
};

}  // namespace grainsweep::coupling
