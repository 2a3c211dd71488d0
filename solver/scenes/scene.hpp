// Scene: a closed experiment that advances with its own time step. It can be observed, saved and restored at any moment
// without changing its answer.
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

/// Health of a state: the reason why it is not sound, with place and time. Empty reason: sound.
struct Health {
    std::string reason;
    [[nodiscard]] bool stable() const { return reason.empty(); }
};

/// Store of expensive starting states shared by cases (packing, settled bed, periodic flow). The key is the canonical
/// text of all inputs that determine the artefact. Results have the same bits with and without the store.
class Artefacts {
public:
    virtual ~Artefacts() = default;
    [[nodiscard]] virtual std::optional<Bytes> get(std::string_view key) = 0;
    virtual void put(std::string_view key, std::span<const std::byte> contents) = 0;
};

/// Store that keeps nothing: every artefact is computed anew.
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
    /// The slices do not change the result.
    virtual void advance(double until) = 0;
    /// Sets the largest number of threads of the next advance(), including the calling thread; 0: one for each core.
    /// The result does not change. A scene may always use one thread. Returns the number of threads that have work now.
    virtual int use_threads(int count) { return static_cast<void>(count), 1; }
    /// Adds all measurements so far, without changing the scene.
    virtual void observe(Observations& into) const = 0;
    /// Returns the physical time since the start, s. It grows with every advance until finished.
    [[nodiscard]] virtual double time() const = 0;
    [[nodiscard]] virtual bool finished() const = 0;
    /// Returns the share of the work done, 0 to 1.
    [[nodiscard]] virtual double progress() const = 0;
    [[nodiscard]] virtual Health health() const { return {}; }
    /// Returns a remark on a sound answer in one sentence, which depends on inputs and seed alone; usually empty.
    [[nodiscard]] virtual std::string remark() const { return {}; }
    /// Returns the work done so far: mobile particles times steps.
    [[nodiscard]] virtual double particle_steps() const { return 0; }
    /// Returns the seconds by phase, if the scene measures them.
    [[nodiscard]] virtual std::map<std::string, double, std::less<>> phase_seconds() const { return {}; }
    /// Saves the complete state. A scene of the same inputs and seed restored from it continues with the same bits.
    virtual void save(Bytes& into) const = 0;
    virtual void restore(std::span<const std::byte> from) = 0;
    [[nodiscard]] virtual Snapshot snapshot() const { return {}; }
    /// Returns the period of a motion that would flicker in a film. Pictures should be taken at whole multiples of this
    /// period. 0: none.
    [[nodiscard]] virtual double picture_period() const { return 0; }
    /// Returns the time at which the main part of the case begins, after a preparation that needs few pictures; 0: at
    /// once.
    [[nodiscard]] virtual double picture_focus() const { return 0; }
    /// Returns whether the case may end long before progress() foresees it.
    [[nodiscard]] virtual bool may_end_early() const { return false; }
};

/// Expected cost of a case, for planning and order only.
struct CostEstimate {
    double seconds = 0;         ///< of an average core
    double particle_steps = 0;  ///< as of Scene; 0: unknown
    double bytes = 0;           ///< largest memory; 0: little
};

/// Scalar observable that text output shows first, with its meaning in at most about 26 characters.
struct MainObservable {
    std::string name, words;
};

/// Description of a kind of scene.
struct SceneInfo {
    std::string name;
    std::string summary;
    std::string label = {};  ///< shown instead of a name that is a hash; empty: the name
    int revision = 1;        ///< part of every case id; raised whenever results or defaults change on purpose
    std::vector<ParameterSpec> parameters;
    std::vector<ObservableSpec> observables;
    /// Scalars that most users need, most important first. Empty: the first ones of `observables`.
    std::vector<MainObservable> main = {};
    /// Named sets of numerical inputs: "fast", "balanced", "fine" (`reference` in mixed precision), "reference". Empty:
    /// the scene offers none.
    std::map<std::string, Inputs, std::less<>> accuracy;
    std::string stiffness = {};  ///< parameter that the stiffness of contacts is proportional to; empty: none

    /// Function that make() calls.
    std::function<std::unique_ptr<Scene>(const Inputs&, std::uint64_t seed, Artefacts&, const Files&)> maker;
    /// Cost estimate. Throws like `maker` if the combination of inputs is impossible or a file is not given.
    std::function<CostEstimate(const Inputs&, const Files&)> estimate_cost;
    /// Answer that is proven without simulation; may be empty.
    std::function<std::optional<ProvenAnswer>(const Inputs&)> proven_answer;
    /// Warnings before a case runs, at most one of each kind. Only for inputs that make() accepts; may be empty.
    std::function<std::vector<Warning>(const Inputs&, const Files&)> warnings;
    /// Inputs of the n-th attempt, if they differ from the case's: only for the rehearsal, which can fail in the first
    /// attempts alone.
    std::function<Inputs(Inputs, std::int64_t attempt)> on_attempt;

    /// Returns a scene at time 0 from complete inputs (every parameter present) and the contents of their files. Throws
    /// std::invalid_argument with one sentence if the combination of inputs is impossible, or a file is invalid or not
    /// among `files`.
    [[nodiscard]] std::unique_ptr<Scene> make(const Inputs& inputs, std::uint64_t seed, Artefacts& artefacts,
                                              const Files& files = {}) const {
        return maker(inputs, seed, artefacts, files);
    }
    [[nodiscard]] const std::string& shown() const { return label.empty() ? name : label; }
    [[nodiscard]] const ParameterSpec* find_parameter(std::string_view parameter) const;
    [[nodiscard]] const ObservableSpec* find_observable(std::string_view observable) const;
    [[nodiscard]] Inputs defaults() const;
};

/// Returns the solver's own scenes, in the order of display.
[[nodiscard]] std::span<const SceneInfo> scene_catalogue();
/// Handle of a scene. The scene exists until its last handle is gone.
using SharedScene = std::shared_ptr<const SceneInfo>;
/// Registers another scene in this process; it replaces a scene of the same name.
SharedScene enter_scene(SceneInfo scene);
/// Returns a scene of the solver or a registered scene; nullptr if there is none of this name.
[[nodiscard]] SharedScene find_scene(std::string_view name);
/// Returns a handle of a scene that outlives it.
[[nodiscard]] inline SharedScene unowned(const SceneInfo& scene) {
    return {std::shared_ptr<void>(), &scene};
}
/// Returns the label of the scene of this name; the name if it has no label.
[[nodiscard]] std::string shown_scene(std::string_view name);

/// Returns the instruction set of the solver's inner loops in this process, one of instruction_path_words().
[[nodiscard]] std::string_view instruction_path();
/// Returns the words of choose_instruction_path: "avx2" and "avx512"; on other processors than x86 "baseline".
[[nodiscard]] std::span<const std::string_view> instruction_path_words();
/// Makes the particle loops of this process use a narrower instruction set than the widest available, for tests and
/// benchmarks. Call it before a scene is made. Returns false without a change if this processor lacks the set. Throws
/// std::invalid_argument for any other word.
[[nodiscard]] bool choose_instruction_path(std::string_view word);

/// Returns whether this processor has an instruction set of the particle loops.
[[nodiscard]] bool processor_suffices();
/// Returns why the program cannot run on a processor; empty if it can.
[[nodiscard]] std::string unsupported_processor(bool suffices = processor_suffices());

/// Sets the largest number of threads of a case in this process; 0: one for each core; initially 1. May be called from
/// any thread; the case uses the number from its next slice on.
void allow_threads(int count);
[[nodiscard]] int allowed_threads();

}  // namespace grainsweep
