#include "tests/support/tpms_cells.hpp"

namespace grainsweep::tests {

dem::Setup cell_of(const particles::TpmsFilling& filling, double edge, double cohesion, double floor) {
    dem::Setup s;
    for (std::size_t k = 0; k < 3; ++k) {
        s.domain.low[k] = -(2 + (k == 2 ? floor * edge : 0)) * cell_diameter;
        s.domain.high[k] = (edge + 2) * cell_diameter;
    }
    s.material.youngs_modulus = 2.11e6;
    s.material.restitution = 0.64;
    s.material.friction = 0.5;
    s.material.cohesion = cohesion;
    s.gravity = {0, 0, -9.81 * 100 / edge};
    s.time_step = 1e-6;
    const auto add = [&](const auto& places, bool mobile) {
        for (const auto& x : places)
            s.spheres.push_back({{x[0] * cell_diameter, x[1] * cell_diameter, x[2] * cell_diameter},
                                 {},
                                 {},
                                 cell_diameter / 2,
                                 mobile});
    };
    add(filling.mobile, true);
    add(filling.wall, false);
    return s;
}

std::unique_ptr<Scene> run_in_slices(const std::function<std::unique_ptr<Scene>()>& make, Bytes& checkpoint) {
    auto scene = make();
    double until = 0;
    for (int slice = 0; !scene->finished(); ++slice) {
        until += 1e-6 * (37 + 211 * (slice % 3));
        scene->advance(until);
        if (slice % 4 != 3) continue;
        checkpoint.clear();
        scene->save(checkpoint);
        scene = make();
        scene->restore(checkpoint);
    }
    return scene;
}

}  // namespace grainsweep::tests
