// Triply periodic minimal surfaces as level sets, and the thickness of a shell around them.
//
// A cell is the cube [0, L]^3. With bar coordinates X = pi (2 x / L - 1) in [-pi, pi] the surface is f(X) = 0:
//   schwarz_p  cos X + cos Y + cos Z
//   gyroid     sin X cos Y + sin Z cos X + sin Y cos Z
//   diamond    cos X cos Y cos Z - sin X sin Y sin Z
//   iwp        2 (cos X cos Y + cos Z cos X + cos Y cos Z) - (cos 2X + cos 2Y + cos 2Z)
//   frd        4 cos X cos Y cos Z - (cos 2X cos 2Y + cos 2Y cos 2Z + cos 2Z cos 2X)
//   i2y        -2 (sin 2X cos Y sin Z + sin 2Z cos X sin Y + sin 2Y cos Z sin X)
//              + cos 2X cos 2Y + cos 2Y cos 2Z + cos 2Z cos 2X
// (Gupta, Ness & Haeri, table 2). The shell is |f| <= C with C = G sin(pi t / L). For schwarz_p, gyroid and diamond G
// is the smallest |grad f| on f = 0, so that t is the largest local thickness of the shell to first order; for the
// first two this equals the study's C. For the other three the study states no C, and G is the value of the reference
// runs. Their smallest gradients are 3.3755, 2.5460 and 3.4641 = 2 sqrt 3, so the largest thickness is 0.983, 0.975 and
// 0.937 of t.
#pragma once

#include <array>
#include <string_view>

namespace grainsweep::geometry {

enum class TpmsCell { schwarz_p, gyroid, diamond, iwp, frd, i2y };

/// Traits of a cell.
struct TpmsTraits {
    TpmsCell cell;
    std::string_view name;
    int kept_side;          ///< default sign of f on the side that is filled with powder
    double shell_gradient;  ///< G: C = G sin(pi t / L)
    double steepest;        ///< largest |grad f| anywhere, rounded up
};

/// Traits of the six cells, in the order of the study's table 2.
inline constexpr std::array<TpmsTraits, 6> tpms_cells = {{
    {TpmsCell::schwarz_p, "schwarz_p", +1, 1.0, 1.7321},
    {TpmsCell::gyroid, "gyroid", +1, 1.4142135623730951, 1.7321},
    {TpmsCell::diamond, "diamond", +1, 1.0, 1.2248},
    {TpmsCell::iwp, "iwp", -1, 3.3166, 5.1962},
    {TpmsCell::frd, "frd", -1, 2.483, 7.041},
    {TpmsCell::i2y, "i2y", -1, 3.246, 6.9283},
}};

[[nodiscard]] const TpmsTraits& traits(TpmsCell cell);

/// Returns f at the bar coordinates X, Y, Z (any real numbers; the period is 2 pi).
[[nodiscard]] double tpms_value(TpmsCell cell, const std::array<double, 3>& bar);

}  // namespace grainsweep::geometry
