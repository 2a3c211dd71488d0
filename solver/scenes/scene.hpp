// What a scene is: a closed experiment that advances in its own time step and can be observed, saved and
// restored at any moment without changing what it will answer.
#pragma once

#include "solver/scenes/values.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep {

using Bytes = std::vector<std::byte>;

/// Why a state is no longer sound: what, where, when. Empty reason: sound.
struct Health {
    std::string reason;
    [[nodiscard]] bool stable() const { return reason.empty(); }
};

/// Expensive starting states shared by cases (packing, settled bed, periodic flow). The key is the
/// canonical text of the inputs that determine the artefact and nothing else; with or without the store
/// the bits of the result are the same.
class Artefacts {
public:
    virtual ~Artefacts() = default;
    [[nodiscard]] virtual std::optional<Bytes> get(std::string_view key) = 0;
    virtual void put(std::string_view key, std::span<const std::byte> contents) = 0;
};

/// Keeps nothing: every artefact is computed anew.
class NoArtefacts final : public Artefacts {
public:
    [[nodiscard]] std::optional<Bytes> get(std::string_view) override { return std::nullopt; }
    void put(std::string_view, std::span<const std::byte>) override {}
};

class Scene {
public:
    Scene() = default;
    Scene(const Scene&) = delete;
    Scene& operator=(const Scene&) = delete;
    virtual ~Scene() = default;

    /// Integrates in the scene's own steps until time() >= until, finished() or !health().stable().
    /// Where the slices are cut never changes the result.
    virtual void advance(double until) = 0;
    /// Up to `count` threads compute from the next advance() on, the calling one among them; 0: one for each core.
    /// Never changes the result; a scene that always uses one takes no notice. How many have something to do now.
    virtual int use_threads(int count) { return static_cast<void>(count), 1; }
    /// Adds everything measured so far. Reads only.
    virtual void observe(Observations& into) const = 0;
    /// Physical time since the start, s. Grows with every advance until finished.
    [[nodiscard]] virtual double time() const = 0;
    [[nodiscard]] virtual bool finished() const = 0;
    /// Share of the work done, 0 to 1.
    [[nodiscard]] virtual double progress() const = 0;
    [[nodiscard]] virtual Health health() const { return {}; }
    /// What a reader of a sound answer must know beside it, in one sentence; follows from inputs and seed. Mostly
    /// empty.
    [[nodiscard]] virtual std::string remark() const { return {}; }
    /// Work done so far: mobile particles times steps.
    [[nodiscard]] virtual double particle_steps() const { return 0; }
    /// Seconds by phase, where the scene measures them.
    [[nodiscard]] virtual std::map<std::string, double, std::less<>> phase_seconds() const { return {}; }
    /// Complete state; a scene made with the same inputs and seed and restored from it continues bit for bit.
    virtual void save(Bytes& into) const = 0;
    virtual void restore(std::span<const std::byte> from) = 0;
    [[nodiscard]] virtual Snapshot snapshot() const { return {}; }
    /// Of a motion that repeats itself and would flicker in a film: pictures further apart than this are best taken at
    /// whole multiples of it. 0: none.
    [[nodiscard]] virtual double picture_period() const { return 0; }
    /// When what the case is about begins, after a preparation that most pictures may pass over; 0: at once.
    [[nodiscard]] virtual double picture_focus() const { return 0; }
};

/// What a case will probably take, for planning and order only.
struct CostEstimate {
    double seconds = 0;         ///< of a plain core
    double particle_steps = 0;  ///< as of Scene; 0: not known
    double bytes = 0;           ///< of memory at most; 0: little
};

/// Everything known about a kind of scene without making one.
struct SceneInfo {
    std::string name;
    std::string summary;
    std::string label = {};  ///< shown instead of the name, where that is a hash; empty: the name
    int revision = 1;        ///< part of every case id; grows whenever results or defaults change on purpose
    std::vector<ParameterSpec> parameters;
    std::vector<ObservableSpec> observables;
    /// Named sets of numerical inputs: "fast", "balanced", "fine" (`reference` in mixed precision), "reference". Empty:
    /// the scene offers none.
    std::map<std::string, Inputs, std::less<>> accuracy;
    std::string stiffness = {};  ///< parameter that the stiffness of contacts is proportional to; empty: none

    /// What make() calls.
    std::function<std::unique_ptr<Scene>(const Inputs&, std::uint64_t seed, Artefacts&, const Files&)> maker;
    /// Throws as maker does where the inputs are impossible together or a file is not given.
    std::function<CostEstimate(const Inputs&, const Files&)> estimate_cost;
    /// The answer, where it is proven without simulation; may be empty.
    std::function<std::optional<ProvenAnswer>(const Inputs&)> proven_answer;
    /// What a user must know before asking this: at most one warning of a kind. Only for inputs that make() accepts;
    /// may be empty.
    std::function<std::vector<Warning>(const Inputs&, const Files&)> warnings;
    /// What the n-th attempt really does, where that differs from what was asked: only the rehearsal, whose
    /// misbehaviour may be limited to the first attempts.
    std::function<Inputs(Inputs, std::int64_t attempt)> on_attempt;

    /// A complete map (every parameter present) and the contents of the files it names -> a scene at time 0. Throws
    /// std::invalid_argument with one sentence when inputs are each within bounds but impossible together, and when a
    /// file is none of its kind or not among `files`.
    [[nodiscard]] std::unique_ptr<Scene> make(const Inputs& inputs, std::uint64_t seed, Artefacts& artefacts,
                                              const Files& files = {}) const {
        return maker(inputs, seed, artefacts, files);
    }
    [[nodiscard]] const std::string& shown() const { return label.empty() ? name : label; }
    [[nodiscard]] const ParameterSpec* find_parameter(std::string_view parameter) const;
    [[nodiscard]] const ObservableSpec* find_observable(std::string_view observable) const;
    [[nodiscard]] Inputs defaults() const;
};

/// The solver's own scenes, in the order they are shown.
[[nodiscard]] std::span<const SceneInfo> scene_catalogue();
/// Makes another scene known to this process, for its lifetime; takes the place of one of the same name.
const SceneInfo& enter_scene(SceneInfo scene);
/// One of both; nullptr when there is none of that name.
[[nodiscard]] const SceneInfo* find_scene(std::string_view name);
/// The label of the scene of that name; the name itself where it has none.
[[nodiscard]] std::string shown_scene(std::string_view name);

/// Instruction set of the solver's inner loops in this process: "x86-64-v2", "avx2", "avx512"; elsewhere "baseline".
[[nodiscard]] std::string_view instruction_path();
/// Words of choose_instruction_path: "baseline" (x86-64-v2, NEON), "avx2", "avx512".
[[nodiscard]] std::span<const std::string_view> instruction_path_words();
/// Makes the particle loops of this process run with a narrower instruction set than the widest there is, for tests
/// and benchmarks; to be called before a scene is made. False, and nothing changes: this processor lacks it.
/// Throws std::invalid_argument on any other word.
[[nodiscard]] bool choose_instruction_path(std::string_view word);

/// How many threads a case in this process may have; 0: one for each core. At the start 1. May be called from any
/// thread: the case takes it up at its next slice.
void allow_threads(int count);
[[nodiscard]] int allowed_threads();

}  // namespace grainsweep
