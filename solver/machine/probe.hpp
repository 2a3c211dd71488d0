// A probe looks at the particles at a moment and gives one value, or a profile of values.
//
// A probe is one file in solver/machine/probes/ and one line in its catalogue: its options, and how it looks.
#pragma once

#include "solver/bytes.hpp"
#include "solver/dem/engine.hpp"
#include "solver/machine/region.hpp"
#include "solver/scenes/values.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace grainsweep::machine {

inline constexpr double undefined = std::numeric_limits<double>::quiet_NaN();

/// What a probe may look at, at a moment.
struct Sight {
    const dem::Engine& engine;
    const dem::State& state;                         ///< of all particles present
    const std::vector<dem::ContactForce>& contacts;  ///< empty, unless the probe needs them
    std::span<const std::uint8_t> species;           ///< by id
    std::span<const double> density;                 ///< by id, kg/m3
    const geometry::Domain& domain;
    Vec3 gravity{};
    double time = 0;                      ///< s since the start
    double peak_overlap = 0;              ///< the deepest at any step since the phase began
    std::span<const double> radius = {};  ///< by id, of all there ever were, m
    double time_step = 0;                 ///< s

    [[nodiscard]] std::size_t size() const { return state.id.size(); }
    [[nodiscard]] std::size_t id(std::size_t i) const { return static_cast<std::size_t>(state.id[i]); }
    [[nodiscard]] std::size_t species_of(std::size_t i) const { return species[id(i)]; }
    [[nodiscard]] double volume(std::size_t i) const;  ///< m3
    [[nodiscard]] double mass(std::size_t i) const { return density[id(i)] * volume(i); }
};

/// Values of the options of a probe.
using OptionValue = std::variant<double, Vec3, Region, std::vector<std::size_t>, std::string>;

class Options {
public:
    void set(std::string_view name, OptionValue value) {
        values_.insert_or_assign(std::string(name), std::move(value));
    }
    [[nodiscard]] double number(std::string_view name) const { return std::get<double>(values_.at(std::string(name))); }
    [[nodiscard]] double number(std::string_view name, double standard) const {
        return has(name) ? number(name) : standard;
    }
    [[nodiscard]] Vec3 vector(std::string_view name) const { return std::get<Vec3>(values_.at(std::string(name))); }
    [[nodiscard]] Vec3 vector(std::string_view name, const Vec3& standard) const {
        return has(name) ? vector(name) : standard;
    }
    /// None: everywhere.
    [[nodiscard]] std::optional<Region> region(std::string_view name) const {
        return has(name) ? std::optional(std::get<Region>(values_.at(std::string(name)))) : std::nullopt;
    }
    /// Species or walls by number; none: all.
    [[nodiscard]] std::vector<std::size_t> numbers(std::string_view name) const {
        return has(name) ? std::get<std::vector<std::size_t>>(values_.at(std::string(name)))
                         : std::vector<std::size_t>{};
    }
    [[nodiscard]] std::string word(std::string_view name, std::string_view standard) const {
        return has(name) ? std::get<std::string>(values_.at(std::string(name))) : std::string(standard);
    }
    [[nodiscard]] bool has(std::string_view name) const { return values_.find(name) != values_.end(); }
    [[nodiscard]] const std::map<std::string, OptionValue, std::less<>>& all() const { return values_; }

private:
    std::map<std::string, OptionValue, std::less<>> values_;
};

/// An option, as a machine file gives it.
struct OptionSpec {
    enum class Kind { number, vector, direction, region, species, walls, word };
    std::string_view name;
    Kind kind = Kind::number;
    std::string_view unit;
    std::string_view meaning;
    bool required = false;
    Interval bounds = {};
    std::span<const std::string_view> words = {};
};

class Probe {
public:
    Probe() = default;
    Probe(const Probe&) = delete;
    Probe& operator=(const Probe&) = delete;
    virtual ~Probe() = default;

    /// Returns the value at this moment; undefined where there is none. Of a profile: one number that sums it up, or
    /// undefined.
    [[nodiscard]] virtual double look(const Sight& sight) = 0;
    /// Sees every step of the phases that count, where its row says so; the contacts are those of the step itself
    /// (dem::Engine::step_contacts).
    virtual void step(const Sight&) {}
    /// Appends bins and values at this moment; a scalar has none.
    virtual void profile(const Sight&, std::vector<Sample>&) {}
    /// What it remembers from look to look.
    virtual void save(ByteWriter&) const {}
    virtual void restore(ByteReader&) {}
};

struct ProbeInfo {
    std::string_view name, unit, meaning;
    std::span<const OptionSpec> options;
    std::unique_ptr<Probe> (*make)(const Options&);
    bool contacts = false;       ///< looks at contacts
    std::string_view over = {};  ///< of a profile: what it runs along, with its unit
    /// What is wrong with the options together, in one sentence; empty: nothing. May be absent.
    std::string (*flaw)(const Options&) = nullptr;
    bool steps = false;  ///< sees every step, which costs about twenty steps
};

/// All probes, sorted by name.
[[nodiscard]] std::span<const ProbeInfo> probe_catalogue();
/// Returns nullptr where there is none of that name.
[[nodiscard]] const ProbeInfo* find_probe(std::string_view name);

}  // namespace grainsweep::machine
