// Contacts of the mixed engine's present state, in SI and double precision, by the laws of the clear engine.
//
// Positions are the exact integers that forces are computed from, springs those the last step left. Not part of a
// step: this is read when somebody asks.
#pragma once

#include <span>
#include <vector>

#include "solver/dem/engine.hpp"
#include "solver/dem/fast/layout.hpp"
#include "solver/dem/fast/rebuild.hpp"
#include "solver/dem/laws/cohesion.hpp"
#include "solver/dem/laws/contact.hpp"
#include "solver/dem/laws/hertz.hpp"
#include "solver/dem/laws/mindlin.hpp"

namespace grainsweep::dem::fast {

/// Of one particle, at the full step.
struct Motion {
    Vec3 velocity{};  ///< m/s
    Vec3 spin{};      ///< rad/s
};

class ContactReader {
public:
    /// All views must outlive the reader; `motions` in the order of the records.
    ContactReader(const Material& material, const Room& room, const Field& field, const std::int32_t* id,
                  std::span<const Motion> motions, std::int32_t width);

    /// Appends the touching pairs, in list order.
    void pairs(std::vector<ContactForce>& into) const;
    /// Appends the particles that touch wall number w at time t since the walls were set.
    void wall(const Wall& wall, std::size_t w, double time, std::vector<ContactForce>& into) const;

private:
    using Laws = Contact<Hertz, Cohesion<ChosenArea>, Mindlin, Cohesion<ChosenArea>>;

    [[nodiscard]] double radius(std::int32_t i) const;
    [[nodiscard]] double mass(std::int32_t i) const;  ///< kg; infinite where frozen
    void pair(std::int32_t i, std::int32_t j, const Vec3& spring, std::vector<ContactForce>& into) const;
    template <Partner partner>
    void add(Touch<partner>& t, std::int32_t i, std::int32_t second, const Vec3& velocity, const Vec3& turn,
             Vec3 spring, std::vector<ContactForce>& into) const;

    const Room& room_;
    const Field& field_;
    const std::int32_t* id_;
    std::span<const Motion> motions_;
    std::int32_t width_;
    Laws laws_;
};

}  // namespace grainsweep::dem::fast
