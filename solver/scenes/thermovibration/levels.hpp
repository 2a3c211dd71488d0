// Levels of coupling that a case can choose, with their traits.
#pragma once

#include "solver/coupling/levels.hpp"
#include "solver/coupling/solids_volume.hpp"
#include "solver/flow/flow.hpp"
#include "solver/threads/slabs.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace grainsweep::thermovibration {

using Drag = coupling::SchillerNaumann;
struct Question;

/// Fluid and particles advanced together: a Suspension or a DenseSuspension.
class Coupled {
public:
    Coupled() = default;
    Coupled(const Coupled&) = delete;
    Coupled& operator=(const Coupled&) = delete;
    virtual ~Coupled() = default;

    /// Sets the threads that compute a step; no bit depends on their number.
    virtual void use(const Slabs& slabs) = 0;
    virtual void step() = 0;
    [[nodiscard]] virtual const flow::Flow<flow::Boussinesq>& fluid() const = 0;
    [[nodiscard]] virtual const coupling::Cloud& cloud() const = 0;
    /// Returns the volume of the particles on the grid; nullptr: they displace no fluid.
    [[nodiscard]] virtual const coupling::SolidsVolume* solids() const = 0;
    /// Returns the momentum exchanged in the last step; nullptr: the particles do not act on the fluid.
    [[nodiscard]] virtual const coupling::MomentumBudget* budget() const = 0;
    /// Returns the number of steps in which a packing limit moved particles; empty: there is no limit.
    [[nodiscard]] virtual std::optional<std::int64_t> limited_steps() const = 0;
    virtual void save(std::vector<std::byte>& into) const = 0;
    virtual void restore(std::span<const std::byte>& from) = 0;
};

struct LevelInfo {
    std::string_view name;
    bool acts_on_fluid = false;
    bool dense = false;              ///< particles displace fluid
    bool stressed = false;           ///< solids pressure and a packing limit
    bool resolves_contacts = false;  ///< particles start without overlaps
    double seconds_on_grid = 0;      ///< of a step on 40^3 cells, without fluid and spreading
    std::unique_ptr<Coupled> (*make)(const Question&, std::uint64_t seed);
};

/// Returns the levels, the simplest first.
[[nodiscard]] std::span<const LevelInfo> levels();
/// Returns the level of an existing name.
[[nodiscard]] const LevelInfo& level_named(std::string_view name);

}  // namespace grainsweep::thermovibration
