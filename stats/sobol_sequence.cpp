#include "stats/sobol_sequence.hpp"

#include "stats/random.hpp"

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

std::uint64_t owen_scrambled(std::uint64_t fraction, std::uint64_t key) {
    std::uint64_t scrambled = 0;
    std::uint64_t path = 1;  // a leading one, then the digits so far: the node of the binary tree
    for (unsigned l = scrambled_digits; l-- > 0;) {
        const std::uint64_t digit = (fraction >> l) & 1U;
        const std::uint64_t flip = splitmix64(key ^ path) >> 63U;
        scrambled = (scrambled << 1U) | (digit ^ flip);
        path = (path << 1U) | digit;
    }
    return scrambled;
}

}  // namespace grainsweep::stats
