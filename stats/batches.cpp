#include "stats/batches.hpp"

#include <algorithm>
#include <cassert>
#include <span>

namespace grainsweep::stats {

std::array<Summary, StretchedSample::batches> StretchedSample::leave_one_out() {
    assert(values_.size() >= 2 * batches);
    std::array<Moments, batches> parts;
    for (std::size_t g = 0; g < batches; ++g)
        parts[g].add(std::span(values_).subspan(first_of(g), first_of(g + 1) - first_of(g)));
    const auto middle = middles();
    std::array<Summary, batches> summaries;
    for (std::size_t left_out = 0; left_out < batches; ++left_out) {
        Moments moments;
        for (std::size_t g = 0; g < batches; ++g)
            if (g != left_out) moments.merge(parts[g]);
        summaries[left_out] = moments.summary(middle[left_out]);
    }
    return summaries;
}

std::array<Middle, StretchedSample::batches> StretchedSample::middles() {
    const auto old = static_cast<std::ptrdiff_t>(ranked_.size());
    for (std::size_t i = ranked_.size(); i < values_.size(); ++i) ranked_.push_back({values_[i], i});
    std::ranges::sort(ranked_.begin() + old, ranked_.end(), {}, &Ranked::value);
    std::ranges::inplace_merge(ranked_, ranked_.begin() + old, {}, &Ranked::value);

    // Walking up the sorted values, `passed` counts those of each stretch: i + 1 - passed[g] values of the
    // others lie at or below place i.
    std::array<Middle, batches> middles;
    std::array<std::size_t, batches> passed{};
    for (std::size_t i = 0, open = batches; open > 0; ++i) {
        const std::size_t own = std::min(ranked_[i].position * batches / values_.size(), batches - 1);
        const std::size_t stretch = ranked_[i].position >= first_of(own + 1) ? own + 1 : own;
        ++passed[stretch];
        for (std::size_t g = 0; g < batches; ++g) {
            if (g == stretch) continue;
            const std::size_t others = values_.size() - (first_of(g + 1) - first_of(g));
            const std::size_t reached = i + 1 - passed[g];
            if (reached == (others - 1) / 2 + 1) middles[g].low = ranked_[i].value;
            if (reached == others / 2 + 1) {
                middles[g].high = ranked_[i].value;
                --open;
            }
        }
    }
    return middles;
}

}  // namespace grainsweep::stats
