#include "tests/support/trajectory_case.hpp"

#include "tests/support/blade.hpp"

#include <nlohmann/json.hpp>

namespace grainsweep::tests {

dem::Setup setup_of(const nlohmann::json& c) {
    dem::Setup s;
    s.domain = {{-1, -1, -1}, {1, 1, 1}, {}};
    s.material.youngs_modulus = c["E"];
    s.material.poisson_ratio = c["nu"];
    s.material.density = c["rho"];
    s.material.restitution = c["e"];
    s.material.friction = c["mu"];
    s.material.tangential_limit = dem::TangentialLimit::spring;
    if (c["coh"] != "") {
        s.material.cohesion = c["k"];
        s.material.cohesion_law = c["coh"] == "sjkr" ? dem::CohesionLaw::sjkr : dem::CohesionLaw::sjkr2;
    }
    s.gravity = {0, 0, c["grav"].get<bool>() ? -9.81 : 0.0};
    s.time_step = c["dt"];
    for (const auto& atom : c["atoms"])
        s.spheres.push_back({atom[1], atom[2], atom[3], atom[0].get<double>() / 2, true});
    if (!c["wall"].is_null()) s.walls.emplace_back(dem::Plane{{0, 0, 0}, {0, 0, 1}});
    if (!c["blade"].is_null()) {
        const auto& b = c["blade"];
        s.walls.emplace_back(Blade{b["xf"], b["th"], b["gap"], 0.15, b["v"], 0, 0, 0});
    }
    return s;
}

}  // namespace grainsweep::tests
