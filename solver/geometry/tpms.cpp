#include "solver/geometry/tpms.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

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

double value_of(TpmsCell cell, const Waves& w) {
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

std::array<double, 3> gradient_of(TpmsCell cell, const Waves& w) {
    switch (cell) {
        case TpmsCell::schwarz_p:
            return {-w.sx, -w.sy, -w.sz};
        case TpmsCell::gyroid:
            return {w.cx * w.cy - w.sz * w.sx, w.cy * w.cz - w.sx * w.sy, w.cz * w.cx - w.sy * w.sz};
        case TpmsCell::diamond:
            return {-w.sx * w.cy * w.cz - w.cx * w.sy * w.sz, -w.cx * w.sy * w.cz - w.sx * w.cy * w.sz,
                    -w.cx * w.cy * w.sz - w.sx * w.sy * w.cz};
        case TpmsCell::iwp:
            return {-2 * w.sx * (w.cy + w.cz) + 2 * w.s2x, -2 * w.sy * (w.cz + w.cx) + 2 * w.s2y,
                    -2 * w.sz * (w.cx + w.cy) + 2 * w.s2z};
        case TpmsCell::frd:
            return {-4 * w.sx * w.cy * w.cz + 2 * w.s2x * (w.c2y + w.c2z),
                    -4 * w.cx * w.sy * w.cz + 2 * w.s2y * (w.c2z + w.c2x),
                    -4 * w.cx * w.cy * w.sz + 2 * w.s2z * (w.c2x + w.c2y)};
        case TpmsCell::i2y:
            return {-2 * (2 * w.c2x * w.cy * w.sz - w.s2z * w.sx * w.sy + w.s2y * w.cz * w.cx) -
                        2 * w.s2x * (w.c2y + w.c2z),
                    -2 * (2 * w.c2y * w.cz * w.sx - w.s2x * w.sy * w.sz + w.s2z * w.cx * w.cy) -
                        2 * w.s2y * (w.c2z + w.c2x),
                    -2 * (2 * w.c2z * w.cx * w.sy - w.s2y * w.sz * w.sx + w.s2x * w.cy * w.cz) -
                        2 * w.s2z * (w.c2x + w.c2y)};
    }
    return {};
}

}  // namespace

const TpmsTraits& traits(TpmsCell cell) {
    return *std::ranges::find(tpms_cells, cell, &TpmsTraits::cell);
}

std::optional<TpmsCell> tpms_cell_named(std::string_view name) {
    const auto found = std::ranges::find(tpms_cells, name, &TpmsTraits::name);
    if (found == tpms_cells.end()) return std::nullopt;
    return found->cell;
}

double tpms_value(TpmsCell cell, const std::array<double, 3>& bar) {
    return value_of(cell, Waves(bar));
}

LevelSet tpms_level_set(TpmsCell cell, const std::array<double, 3>& bar) {
    const Waves waves(bar);
    return {value_of(cell, waves), gradient_of(cell, waves)};
}

TpmsShell::TpmsShell(TpmsCell cell, int side, double edge, double thickness)
    : cell_(cell), side_(side), edge_(edge), level_(0) {
    if (side != 1 && side != -1) throw std::invalid_argument("the kept side of a TPMS cell is +1 or -1");
    if (!(edge > 0) || !(thickness > 0) || !(thickness < edge / 2))
        throw std::invalid_argument("the shell of a TPMS cell must be thicker than 0 and thinner than half the edge");
    level_ = traits(cell).shell_gradient * std::sin(std::numbers::pi * thickness / edge);
}

double TpmsShell::value(const std::array<double, 3>& point) const {
    std::array<double, 3> bar{};
    for (std::size_t k = 0; k < 3; ++k) bar[k] = std::numbers::pi * (2 * point[k] / edge_ - 1);
    return tpms_value(cell_, bar);
}

TpmsRegion TpmsShell::classify(const std::array<double, 3>& point) const {
    const double f = side_ * value(point);
    if (f > level_) return TpmsRegion::kept;
    return f < -level_ ? TpmsRegion::deleted : TpmsRegion::wall;
}

}  // namespace grainsweep::geometry
