// Contacts of a bed: the mean number of partners, and the deepest overlap.
#include "solver/machine/probe.hpp"
#include "solver/machine/selection.hpp"

namespace grainsweep::machine::probes {
namespace {

class Coordination final : public machine::Probe {
public:
    explicit Coordination(const Options& options) : selection_(options) {}
    double look(const Frame& frame) override {
        std::vector<char> counts(frame.species.size(), 0);
        double particles = 0, partners = 0;
        selection_.each(frame, [&](std::size_t i) {
            counts[frame.id(i)] = 1;
            ++particles;
        });
        for (const auto& contact : frame.contacts) {
            if (contact.second < 0) continue;
            partners +=
                counts[static_cast<std::size_t>(contact.first)] + counts[static_cast<std::size_t>(contact.second)];
        }
        return particles > 0 ? partners / particles : undefined;
    }

private:
    Selection selection_;
};

class Overlap final : public machine::Probe {
public:
    explicit Overlap(const Options& options) : over_steps_(options.word("over", "frames") == "steps") {}
    double look(const Frame& frame) override {
        return over_steps_ ? frame.peak_overlap : frame.engine.largest_overlap();
    }

private:
    bool over_steps_;
};

constexpr std::array contacts_options = {of_option, in_option};
constexpr std::array<std::string_view, 2> over_words = {"frames", "steps"};
constexpr std::array overlap_options = {
    option("over", Field::Kind::word, "",
           "'frames': now, 'steps': the deepest at any step since the phase began; default: "
           "'frames'",
           false, {}, over_words)};

}  // namespace

ProbeInfo coordination() {
    return {"coordination",           "1", "mean number of other particles that a particle touches", contacts_options,
            make_probe<Coordination>, true};
}
ProbeInfo overlap() {
    return {"overlap", "1", "deepest overlap of two particles divided by the diameter of the smaller one",
            overlap_options, make_probe<Overlap>};
}

}  // namespace grainsweep::machine::probes
