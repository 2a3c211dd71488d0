// A bed made by hand for probes to look at, and their options.
#pragma once

#include "solver/machine/probe.hpp"
#include "tests/support/spheres.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace grainsweep::tests {

/// Spheres of two species at places of our own: 2 mm of 1000 kg/m3 and 4 mm of 3000 kg/m3 unless said.
struct Bed {
    dem::Setup setup = empty_space();
    std::vector<std::uint8_t> species;
    std::vector<double> density, radius;
    std::unique_ptr<dem::Engine> engine;
    dem::State state;
    std::vector<dem::ContactForce> contacts;
    geometry::Domain domain{{-1, -1, -1}, {1, 1, 1}, {}};
    double time = 0;

    void add(const geometry::Vec3& x, std::uint8_t of, const geometry::Vec3& v = {}, double diameter = 0) {
        dem::Sphere s;
        s.position = x;
        s.velocity = v;
        s.radius = (diameter > 0 ? diameter : of == 0 ? 0.002 : 0.004) / 2;
        setup.spheres.push_back(s);
        radius.push_back(s.radius);
        species.push_back(of);
        density.push_back(of == 0 ? 1000 : 3000);
    }
    machine::Frame frame() {
        if (!engine) {
            setup.gravity = {0, 0, -9.81};
            engine = dem::make_engine(setup, {});
            engine->state(state);
            engine->contacts(contacts);
        }
        return {*engine, state, contacts, species, density, domain, {0, 0, -9.81}, time, 0, radius};
    }
    /// Takes a sphere away, as one that has left the domain.
    void lose(std::size_t place) {
        (void)frame();
        const auto at = static_cast<std::ptrdiff_t>(place);
        state.id.erase(state.id.begin() + at);
        state.position.erase(state.position.begin() + at);
        state.velocity.erase(state.velocity.begin() + at);
        state.angular_velocity.erase(state.angular_velocity.begin() + at);
        state.radius.erase(state.radius.begin() + at);
        state.mobile.erase(state.mobile.begin() + at);
    }
    double look(const char* probe, const machine::Options& options = {}) {
        return machine::find_probe(probe)->make(options)->look(frame());
    }
};

/// Of a sphere, m3.
inline double volume(double diameter) {
    return std::numbers::pi / 6 * diameter * diameter * diameter;
}

/// Options from names and values.
template <class... Rest>
machine::Options with(std::string_view name, machine::OptionValue value, Rest&&... rest) {
    machine::Options options;
    if constexpr (sizeof...(rest) > 0) options = with(std::forward<Rest>(rest)...);
    options.set(name, std::move(value));
    return options;
}

inline machine::OptionValue of(std::vector<std::size_t> species) {
    return species;
}
inline machine::OptionValue box(const geometry::Vec3& low, const geometry::Vec3& high) {
    return machine::Region{machine::Region::Box{low, high}};
}
inline machine::OptionValue word(const char* text) {
    return std::string(text);
}

}  // namespace grainsweep::tests
