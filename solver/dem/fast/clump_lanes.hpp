// Free rotation of several clumps at a time, one per lane: the step of turn() in solver/dem/body.hpp, with roots by
// Newton's iteration, because quaternions are nearly of unit length. The files of the instruction paths include this
// file; it has internal linkage on purpose.
#pragma once

#include "solver/dem/fast/layout.hpp"

namespace grainsweep::dem::fast {
namespace {

struct LaneQuaternion {
    double w, x, y, z;
};

/// Returns q divided by its length, which lies between 0 and sqrt(3).
inline LaneQuaternion of_unit_length(LaneQuaternion q) {
    const double square = q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z;
    double y = 1.5 - 0.5 * square;
    for (int iteration = 0; iteration < 5; ++iteration) y = y * (1.5 - 0.5 * square * y * y);
    return {y * q.w, y * q.x, y * q.y, y * q.z};
}

/// Returns q + part w q, of unit length.
inline LaneQuaternion moved_on(LaneQuaternion q, const double* w, double part) {
    return of_unit_length(
        {q.w - part * (w[0] * q.x + w[1] * q.y + w[2] * q.z), q.x + part * (q.w * w[0] + w[1] * q.z - w[2] * q.y),
         q.y + part * (q.w * w[1] + w[2] * q.x - w[0] * q.z), q.z + part * (q.w * w[2] + w[0] * q.y - w[1] * q.x)});
}

inline void find_axes(LaneQuaternion q, double (&axes)[3][3]) {
    const auto [w, x, y, z] = q;
    axes[0][0] = w * w + x * x - y * y - z * z, axes[0][1] = 2 * (x * y + w * z), axes[0][2] = 2 * (x * z - w * y);
    axes[1][0] = 2 * (x * y - w * z), axes[1][1] = w * w - x * x + y * y - z * z, axes[1][2] = 2 * (y * z + w * x);
    axes[2][0] = 2 * (x * z + w * y), axes[2][1] = 2 * (y * z - w * x), axes[2][2] = w * w - x * x - y * y + z * z;
}

inline void find_spin(const double (&axes)[3][3], const double* momentum, const double* inverse, double* spin) {
    double along[3];
    for (int k = 0; k < 3; ++k)
        along[k] = inverse[k] * (axes[k][0] * momentum[0] + axes[k][1] * momentum[1] + axes[k][2] * momentum[2]);
    for (int a = 0; a < 3; ++a) spin[a] = along[0] * axes[0][a] + along[1] * axes[1][a] + along[2] * axes[2][a];
}

inline void turn_clumps(TurningClumps& t, double span) {
    for (int k = 0; k < TurningClumps::lanes; ++k) {
        const double momentum[3] = {t.momentum[0][k], t.momentum[1][k], t.momentum[2][k]};
        const double inverse[3] = {t.inverse[0][k], t.inverse[1][k], t.inverse[2][k]};
        const LaneQuaternion q{t.orientation[0][k], t.orientation[1][k], t.orientation[2][k], t.orientation[3][k]};
        double axes[3][3], spin[3];
        find_axes(q, axes);
        find_spin(axes, momentum, inverse, spin);
        const LaneQuaternion whole = moved_on(q, spin, span / 2), middle = moved_on(q, spin, span / 4);
        find_axes(middle, axes);
        find_spin(axes, momentum, inverse, spin);
        const LaneQuaternion halves = moved_on(middle, spin, span / 4);
        const LaneQuaternion end = of_unit_length(
            {2 * halves.w - whole.w, 2 * halves.x - whole.x, 2 * halves.y - whole.y, 2 * halves.z - whole.z});
        find_axes(end, axes);
        t.orientation[0][k] = end.w, t.orientation[1][k] = end.x, t.orientation[2][k] = end.y,
        t.orientation[3][k] = end.z;
        for (int a = 0; a < 3; ++a) {
            t.spin[a][k] = spin[a];
            for (int e = 0; e < 3; ++e) t.axes[e][a][k] = axes[e][a];
        }
    }
}

}  // namespace
}  // namespace grainsweep::dem::fast
