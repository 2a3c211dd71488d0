// Probe: computes one value, or a profile of values, from the particles at a moment.
//
// A probe is one file in solver/machine/probes/ and one row in its catalogue.
#pragma once

#include "solver/bytes.hpp"
#include "solver/dem/engine.hpp"
#include "solver/field.hpp"
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

/// Data that a probe may read at a moment.
struct Frame {
    const dem::Engine& engine;
    /// All particles present: spheres, and each clump as the sphere of equal volume at its centre of mass, with the id
    /// of its first member.
    const dem::State& state;
    const std::vector<dem::ContactForce>& contacts;  ///< of spheres; empty, unless the probe needs them
    std::span<const std::uint8_t> species;           ///< by id
    std::span<const double> density;                 ///< by id, kg/m3
    const geometry::Domain& domain;
    Vec3 gravity{};
    double time = 0;                      ///< s since the start
    double peak_overlap = 0;              ///< largest overlap at any step since the phase began
    std::span<const double> radius = {};  ///< by id, of all particles so far, m
    double time_step = 0;                 ///< s
    /// In step(): the contacts in the order of their partners (partner_order.hpp).
    std::span<const std::uint32_t> by_partners = {};
    std::span<const std::int32_t> particle = {};  ///< by id of a sphere: id of its particle; empty: its own
    const dem::State* members = nullptr;          ///< all spheres and clumps; nullptr: there are no clumps
    std::span<const std::int32_t> named = {};     ///< ids of the particles with a name, in their order
    std::size_t newest = 0;                       ///< least id of the latest filling
    const dem::State* bed = nullptr;              ///< particles from before it, as they were then; nullptr: none

    [[nodiscard]] std::size_t size() const { return state.id.size(); }
    [[nodiscard]] std::size_t id(std::size_t i) const { return static_cast<std::size_t>(state.id[i]); }
    [[nodiscard]] std::size_t species_of(std::size_t i) const { return species[id(i)]; }
    [[nodiscard]] double volume(std::size_t i) const;  ///< m3
    [[nodiscard]] double mass(std::size_t i) const { return density[id(i)] * volume(i); }
    /// Returns the id of the particle that a sphere is, or is a member of.
    [[nodiscard]] std::int32_t particle_of(std::int32_t id) const {
        return particle.empty() ? id : particle[static_cast<std::size_t>(id)];
    }
    /// Returns whether an id is that of a particle, not only of a member.
    [[nodiscard]] bool is_particle(std::size_t id) const {
        return particle.empty() || static_cast<std::size_t>(particle[id]) == id;
    }
    /// Returns all spheres present, members of clumps included.
    [[nodiscard]] const dem::State& spheres() const { return members == nullptr ? state : *members; }
    /// Returns the frame with all spheres as its particles.
    [[nodiscard]] Frame of_spheres() const {
        return {engine, spheres(), contacts,    species,  density, domain, gravity, time, peak_overlap,
                radius, time_step, by_partners, particle, members, named,  newest,  bed};
    }
    /// Calls visit(i, clump) for every clump, with its index in `state`.
    template <class Visit>
    void each_clump(Visit&& visit) const {
        std::size_t i = 0;
        for (const dem::BodyState& clump : spheres().bodies) {
            while (state.id[i] != clump.first) ++i;
            visit(i, clump);
        }
    }
    /// Returns the mass of a particle, present or not, kg.
    [[nodiscard]] double mass_of(std::size_t id) const;
};

/// Passage of a particle's centre through a plane of a probe.
struct Passage {
    std::size_t id = 0, plane = 0;  ///< plane: of Probe::planes()
    bool forward = true;            ///< along the normal
    double time = 0;                ///< s since the start
    Vec3 position{};                ///< m
};

/// Particles that an option selects: species, and particles with a name, by number; both empty: all.
struct SelectedParticles {
    std::vector<std::size_t> species, named;
};

/// Values of the options of a probe.
using OptionValue = std::variant<double, Vec3, Region, std::vector<std::size_t>, SelectedParticles, std::string>;

class Options {
public:
    void set(std::string_view name, OptionValue value) {
        values_.insert_or_assign(std::string(name), std::move(value));
    }
    /// Returns the value of an option of this type; empty: it is left out.
    template <class T>
    [[nodiscard]] std::optional<T> given(std::string_view name) const {
        return has(name) ? std::optional(std::get<T>(values_.at(std::string(name)))) : std::nullopt;
    }
    [[nodiscard]] double number(std::string_view name) const { return given<double>(name).value(); }
    [[nodiscard]] double number(std::string_view name, double standard) const {
        return given<double>(name).value_or(standard);
    }
    [[nodiscard]] Vec3 vector(std::string_view name) const { return given<Vec3>(name).value(); }
    [[nodiscard]] Vec3 vector(std::string_view name, const Vec3& standard) const {
        return given<Vec3>(name).value_or(standard);
    }
    /// Returns the region; empty: everywhere.
    [[nodiscard]] std::optional<Region> region(std::string_view name) const { return given<Region>(name); }
    /// Returns species or walls by number; empty: all.
    [[nodiscard]] std::vector<std::size_t> numbers(std::string_view name) const {
        return given<std::vector<std::size_t>>(name).value_or(std::vector<std::size_t>{});
    }
    /// Returns species and particles; a list of numbers is one of species.
    [[nodiscard]] SelectedParticles particles(std::string_view name) const {
        if (!has(name)) return {};
        const OptionValue& value = values_.at(std::string(name));
        if (const auto* species = std::get_if<std::vector<std::size_t>>(&value)) return {*species, {}};
        return std::get<SelectedParticles>(value);
    }
    [[nodiscard]] std::string word(std::string_view name, std::string_view standard) const {
        return given<std::string>(name).value_or(std::string(standard));
    }
    void each_region(const std::function<void(Region&)>& visit) {
        for (auto& [name, value] : values_)
            if (auto* region = std::get_if<Region>(&value)) visit(*region);
    }
    [[nodiscard]] bool has(std::string_view name) const { return values_.find(name) != values_.end(); }
    [[nodiscard]] const std::map<std::string, OptionValue, std::less<>>& all() const { return values_; }

private:
    std::map<std::string, OptionValue, std::less<>> values_;
};

/// Returns the row of an option of a probe in a machine file.
[[nodiscard]] constexpr Field option(std::string_view name, Field::Kind kind, std::string_view unit,
                                     std::string_view meaning, bool required = false, Interval bounds = {},
                                     std::span<const std::string_view> words = {}) {
    return {name, kind, meaning, {}, bounds, words, required, unit};
}

class Probe {
public:
    Probe() = default;
    Probe(const Probe&) = delete;
    Probe& operator=(const Probe&) = delete;
    virtual ~Probe() = default;

    /// Returns the value at this moment, or undefined. For a profile: one number that summarises it, or undefined.
    [[nodiscard]] virtual double look(const Frame& frame) = 0;
    /// Forgets what it has seen, where each of the phases that repeat counts by itself.
    virtual void restart() {}
    /// Returns the planes whose passages it counts.
    [[nodiscard]] virtual std::vector<dem::CountingPlane> planes() const { return {}; }
    /// Called for every passage in the selected phases, in the order of time. Of `frame` only what is given by id
    /// holds.
    virtual void passed(const Frame&, const Passage&) {}
    /// Called at every step of the selected phases, if the source of the probe is `steps`. The contacts have the
    /// forces of the step itself (dem::Engine::step_contacts).
    virtual void step(const Frame&) {}
    /// Returns the integral of the value over all steps since the start, if the source of the probe is `loads`.
    [[nodiscard]] virtual double integral(const Frame&) { return undefined; }
    /// Appends bins and values at this moment; a scalar appends none.
    virtual void profile(const Frame&, std::vector<Sample>&) {}
    /// Writes the state that it keeps between two calls of look().
    virtual void save(ByteWriter&) const {}
    virtual void restore(ByteReader&) {}
};

/// From what a probe has its values, and so which of them depend on frames.
enum class Source {
    frames,    ///< the particles at a frame
    loads,     ///< loads on walls at a frame; for means and integrals those of every step
    sums,      ///< sums of the engine over every step
    steps,     ///< step(), which costs about as much as eight steps
    passages,  ///< passed()
};

/// What few probes have: each is left out where it does not apply.
struct ProbeTraits {
    bool contacts = false;       ///< reads contacts
    std::string_view over = {};  ///< of a profile: its coordinate with unit
    /// Returns the error of a combination of options, in one sentence; empty: none. May be null.
    std::string (*flaw)(const Options&) = nullptr;
    Source source = Source::frames;
    bool so_far = false;  ///< of all that has been so far, so that its last value says it all
};

struct ProbeInfo : ProbeTraits {
    std::string_view name, unit, meaning;
    std::span<const Field> options;
    std::unique_ptr<Probe> (*make)(const Options&);
};

/// Returns the row of the probes of class P, which are made from their options.
template <class P>
[[nodiscard]] constexpr ProbeInfo probe_row(std::string_view name, std::string_view unit, std::string_view meaning,
                                            std::span<const Field> options, const ProbeTraits& traits = {}) {
    return {traits,  name,
            unit,    meaning,
            options, [](const Options& given) -> std::unique_ptr<Probe> { return std::make_unique<P>(given); }};
}

/// Returns all probes, sorted by name.
[[nodiscard]] std::span<const ProbeInfo> probe_catalogue();
/// Returns the probe of this name; nullptr if there is none.
[[nodiscard]] const ProbeInfo* find_probe(std::string_view name);

}  // namespace grainsweep::machine
