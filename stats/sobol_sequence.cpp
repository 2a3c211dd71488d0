#include "stats/sobol_sequence.hpp"

#include <boost/random/sobol.hpp>

namespace grainsweep::stats {

struct SobolSequence::Engine {
    boost::random::sobol sequence;
};

SobolSequence::SobolSequence(std::size_t dimensions)
    : engine_(std::make_unique<Engine>(Engine{boost::random::sobol(dimensions)})) {
    static_assert(boost::random::sobol::max() == ~std::uint64_t{0});
}

SobolSequence::~SobolSequence() = default;

std::uint64_t SobolSequence::next() {
    return engine_->sequence();
}

std::size_t SobolSequence::most_dimensions() {
    return boost::random::default_sobol_table::max_dimension;
}

}  // namespace grainsweep::stats
