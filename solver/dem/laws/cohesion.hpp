// Cohesion proportional to a contact area (Johnson, Kendall & Roberts, simplified):  F = -k A n.
//
// k is the cohesion energy density (J/m3 = Pa). Three areas are in use; r the distance of the centres:
//     sjkr    pair  A = -pi/4 (r-Ri-Rj)(r+Ri-Rj)(r-Ri+Rj)(r+Ri+Rj)/r^2, the disc where the spheres cut
//             wall  A = pi (2 R d - d^2)                                       (LIGGGHTS 3.8 `sjkr`)
//     sjkr2   pair  A = 4 pi R* d            wall  A = 2 pi R d                (LIGGGHTS 3.8 `sjkr2`)
//     paper   A = pi (2 R* d - d^2)/4, pair and wall alike (Gupta, eq. 15 read literally)
// The area also gives the stored energy, minus k times the integral of A over the overlap.
#pragma once

#include "solver/dem/engine.hpp"
#include "solver/dem/laws/touch.hpp"
#include "solver/particles/needs.hpp"

#include <numbers>

namespace grainsweep::dem {

struct SjkrArea {
    static double area(const Touch<Partner::particle>& t) {
        const double sum = t.radius_i + t.radius_j;
        const double difference = t.radius_i - t.radius_j;
        const double r = t.distance;
        // (r - Ri - Rj) is minus the overlap, which is known more precisely.
        return std::numbers::pi / 4 * t.overlap * (r + sum) * (r - difference) * (r + difference) / (r * r);
    }
    static double area(const Touch<Partner::wall>& t) {
        return std::numbers::pi * (2 * t.radius_i - t.overlap) * t.overlap;
    }
};

struct Sjkr2Area {
    template <Partner partner>
    static double area(const Touch<partner>& t) {
        constexpr double factor = partner == Partner::wall ? 2 : 4;
        return factor * std::numbers::pi * t.effective_radius * t.overlap;
    }
};

struct PaperArea {
    template <Partner partner>
    static double area(const Touch<partner>& t) {
        return std::numbers::pi / 4 * (2 * t.effective_radius - t.overlap) * t.overlap;
    }
};

/// The area chosen by the case, at run time.
struct ChosenArea {
    CohesionArea which = CohesionArea::sjkr;
    template <Partner partner>
    [[nodiscard]] double area(const Touch<partner>& t) const {
        switch (which) {
            case CohesionArea::sjkr:
                return SjkrArea::area(t);
            case CohesionArea::sjkr2:
                return Sjkr2Area::area(t);
            case CohesionArea::paper:
                return PaperArea::area(t);
        }
        return 0;
    }
};

template <class Area>
struct Cohesion {
    static constexpr particles::Needs needs{};

    double density = 0;  ///< k, J/m3
    [[no_unique_address]] Area area{};

    template <bool advance, Partner partner, class Memory>
    void add(const Touch<partner>& t, Response& r, Memory&) const {
        r.normal -= density * area.area(t);
    }

    /// Minus the work of the attraction since first touch, J: every area grows as d to first order.
    template <Partner partner, class Memory>
    [[nodiscard]] double energy(const Touch<partner>& t, const Memory&) const {
        return -0.5 * density * area.area(t) * t.overlap;
    }
};

}  // namespace grainsweep::dem
