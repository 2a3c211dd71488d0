#include "solver/geometry/tpms.hpp"

#include <algorithm>
#include <cmath>

namespace grainsweep::geometry {
namespace {

/// Sines and cosines of the three bar coordinates and of their doubles.
struct Waves {
    double sx, sy, sz, cx, cy, cz;
    double s2x, s2y, s2z, c2x, c2y, c2z;

    explicit Waves(const std::array<double, 3>& bar)
        : sx(std::sin(bar[0])),
          sy(std::sin(bar[1])),
          sz(std::sin(bar[2])),
          cx(std::cos(bar[0])),
          cy(std::cos(bar[1])),
          cz(std::cos(bar[2])),
          s2x(2 * sx * cx),
          s2y(2 * sy * cy),
          s2z(2 * sz * cz),
          c2x(cx * cx - sx * sx),
          c2y(cy * cy - sy * sy),
          c2z(cz * cz - sz * sz) {}
};

}  // namespace

const TpmsTraits& traits(TpmsCell cell) {
    return *std::ranges::find(tpms_cells, cell, &TpmsTraits::cell);
}

double tpms_value(TpmsCell cell, const std::array<double, 3>& bar) {
    const Waves w(bar);
    switch (cell) {
        case TpmsCell::schwarz_p:
            return w.cx + w.cy + w.cz;
        case TpmsCell::gyroid:
            return w.sx * w.cy + w.sz * w.cx + w.sy * w.cz;
        case TpmsCell::diamond:
            return w.cx * w.cy * w.cz - w.sx * w.sy * w.sz;
        case TpmsCell::iwp:
            return 2 * (w.cx * w.cy + w.cz * w.cx + w.cy * w.cz) - (w.c2x + w.c2y + w.c2z);
        case TpmsCell::frd:
            return 4 * w.cx * w.cy * w.cz - (w.c2x * w.c2y + w.c2y * w.c2z + w.c2z * w.c2x);
        case TpmsCell::i2y:
            return -2 * (w.s2x * w.cy * w.sz + w.s2z * w.cx * w.sy + w.s2y * w.cz * w.sx) +
                   (w.c2x * w.c2y + w.c2y * w.c2z + w.c2z * w.c2x);
    }
    return 0;
}

}  // namespace grainsweep::geometry
