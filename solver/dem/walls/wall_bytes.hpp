// Wall in a checkpoint: its parameters, one after the other. They and the time determine its place.
#pragma once

#include "solver/dem/walls/wall.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace grainsweep::dem {

/// Calls visit(part) for every part of a surface.
template <class Of, class Visit>
void for_each_part(Of& surface, Visit&& visit) {
    for (auto* part : {&surface.friction, &surface.rolling_friction, &surface.restitution, &surface.cohesion,
                       &surface.surface_energy})
        visit(*part);
}

/// Calls visit(number) for every number of a material, with words as numbers.
template <class Of, class Visit>
void for_each_number(Of& m, Visit&& visit) {
    const std::array always = {&m.youngs_modulus, &m.poisson_ratio,    &m.density,         &m.restitution,
                               &m.friction,       &m.rolling_friction, &m.rolling_damping, &m.cohesion,
                               &m.surface_energy, &m.stiffness,        &m.tangential_ratio};
    for (auto* part : always) visit(*part);
    visit(m.normal_law);
    visit(m.rolling_law);
    visit(m.cohesion_law);
    visit(m.friction_limit);
    visit(m.tangential_limit);
    for (const Field& member : attraction_of(m).members) {
        auto& number = part(m, member);
        if (std::ranges::find(always, &number) == always.end()) visit(number);
    }
}

/// Calls visit for the members of a shape or motion, or for the whole if it consists of numbers without padding.
template <class Of, class Visit>
void visit_whole(Of& one, Visit&& visit) {
    if constexpr (requires { one.fields(one, visit); }) {
        one.fields(one, visit);
    } else {
        static_assert(std::is_trivially_copyable_v<Of> && sizeof(Of) % sizeof(double) == 0);
        visit(one);
    }
}

/// Writes a shape or a motion; put(value) writes a number, or a struct or an array of numbers.
template <class Variant, class Put>
void write_alternative(const Variant& alternatives, Put&& put) {
    put(static_cast<std::uint64_t>(alternatives.index()));
    std::visit([&](const auto& one) { visit_whole(one, put); }, alternatives);
}

/// Writes all parameters except motions and presence.
template <class Put>
void write_body(const Wall& wall, Put&& put) {
    write_alternative(wall.shape, put);
    for_each_part(wall.surface, [&](const std::optional<double>& part) {
        put(static_cast<std::uint64_t>(part.has_value()));
        put(part.value_or(0));
    });
    put(static_cast<std::uint64_t>(wall.passing));
    put(static_cast<std::uint64_t>(wall.materials.size()));
    for (const Material& m : wall.materials) {
        for_each_number(m, put);
        put(static_cast<std::uint64_t>(m.partner.has_value()));
        put(m.partner.value_or(Elasticity{}));
        put(static_cast<std::uint64_t>(m.tangential_damping.has_value()));
        put(m.tangential_damping.value_or(0));
    }
}

template <class Put>
void write_wall(const Wall& wall, Put&& put) {
    write_body(wall, put);
    put(wall.present);
    put(wall.integrated);
    put(static_cast<std::uint64_t>(wall.motions.size()));
    for (const geometry::Motion& motion : wall.motions) write_alternative(motion, put);
}

/// Returns the alternative with this number, to be filled.
template <class Variant, std::size_t k = 0>
[[nodiscard]] Variant alternative(std::uint64_t index) {
    if constexpr (k == std::variant_size_v<Variant>)
        throw std::invalid_argument("the checkpoint holds a wall that this program does not know");
    else
        return index == k ? Variant(std::in_place_index<k>) : alternative<Variant, k + 1>(index);
}

/// Reads a wall; get(value) reads a value that put wrote. MovingWall checks the result.
template <class Get>
[[nodiscard]] Wall read_wall(Get&& get) {
    const auto read = [&](auto& alternatives) {
        std::uint64_t index = 0;
        get(index);
        alternatives = alternative<std::remove_cvref_t<decltype(alternatives)>>(index);
        std::visit([&](auto& one) { visit_whole(one, get); }, alternatives);
    };
    Wall wall;
    read(wall.shape);
    for_each_part(wall.surface, [&](std::optional<double>& part) {
        std::uint64_t given = 0;
        double value = 0;
        get(given), get(value);
        if (given != 0) part = value;
    });
    std::uint64_t passing = 0;
    get(passing);
    wall.passing = static_cast<std::uint8_t>(passing);
    std::uint64_t materials = 0;
    get(materials);
    for (std::uint64_t k = 0; k < materials; ++k) {
        Material& m = wall.materials.emplace_back();
        for_each_number(m, get);
        std::uint64_t given = 0;
        Elasticity partner;
        get(given), get(partner);
        if (given != 0) m.partner = partner;
        double damping = 0;
        get(given), get(damping);
        if (given != 0) m.tangential_damping = damping;
    }
    get(wall.present);
    get(wall.integrated);
    std::uint64_t motions = 0;
    get(motions);
    for (std::uint64_t k = 0; k < motions; ++k) {
        geometry::Motion motion;
        read(motion);
        wall.motions.push_back(motion);
    }
    return wall;
}

}  // namespace grainsweep::dem
