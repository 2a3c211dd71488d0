#include "sweep/campaign/sieve_series.hpp"

#include <cmath>
#include <span>

namespace grainsweep::campaign {
namespace {

struct Sieve {
    double number, opening;  ///< um
};

// ASTM E11-20, table 1.
constexpr auto astm_sieves = std::to_array<Sieve>(
    {{3.5, 5600}, {4, 4750},  {5, 4000}, {6, 3350},  {7, 2800},  {8, 2360},  {10, 2000}, {12, 1700}, {14, 1400},
     {16, 1180},  {18, 1000}, {20, 850}, {25, 710},  {30, 600},  {35, 500},  {40, 425},  {45, 355},  {50, 300},
     {60, 250},   {70, 212},  {80, 180}, {100, 150}, {120, 125}, {140, 106}, {170, 90},  {200, 75},  {230, 63},
     {270, 53},   {325, 45},  {400, 38}, {450, 32},  {500, 25},  {635, 20}});
// Tyler Standard Screen Scale, at the nominal openings of ISO 3310-1.
constexpr auto tyler_sieves = std::to_array<Sieve>(
    {{2.5, 8000}, {3, 6700},  {3.5, 5600}, {4, 4750},  {5, 4000}, {6, 3350},  {7, 2800},  {8, 2360},  {9, 2000},
     {10, 1700},  {12, 1400}, {14, 1180},  {16, 1000}, {20, 850}, {24, 710},  {28, 600},  {32, 500},  {35, 425},
     {42, 355},   {48, 300},  {60, 250},   {65, 212},  {80, 180}, {100, 150}, {115, 125}, {150, 106}, {170, 90},
     {200, 75},   {250, 63},  {270, 53},   {325, 45},  {400, 38}, {450, 32},  {500, 25},  {635, 20}});
// BS 410: numbers of meshes per inch.
constexpr auto british_sieves =
    std::to_array<Sieve>({{4, 4000},  {5, 3350},  {6, 2800}, {7, 2360}, {8, 2000}, {10, 1700}, {12, 1400},
                          {14, 1180}, {16, 1000}, {18, 850}, {22, 710}, {25, 600}, {30, 500},  {36, 425},
                          {44, 355},  {52, 300},  {60, 250}, {72, 212}, {85, 180}, {100, 150}, {120, 125},
                          {150, 106}, {170, 90},  {200, 75}, {240, 63}, {300, 53}, {350, 45},  {400, 38}});
// ASTM E11-20: sieves named by inches.
constexpr auto inch_sieves = std::to_array<Sieve>(
    {{5, 125000},       {4.24, 106000},   {4, 100000},      {3.5, 90000},     {3, 75000},    {2.5, 63000},
     {2.12, 53000},     {2, 50000},       {1.75, 45000},    {1.5, 37500},     {1.25, 31500}, {1.06, 26500},
     {1, 25000},        {7.0 / 8, 22400}, {0.75, 19000},    {5.0 / 8, 16000}, {0.53, 13200}, {0.5, 12500},
     {7.0 / 16, 11200}, {3.0 / 8, 9500},  {5.0 / 16, 8000}, {0.265, 6700},    {0.25, 6300}});

std::optional<double> opening_among(std::span<const Sieve> sieves, double number) {
    for (const auto& sieve : sieves)
        if (std::abs(sieve.number - number) < 1e-9) return sieve.opening;
    return std::nullopt;
}

}  // namespace

std::optional<double> sieve_opening(SieveSeries series, double number) {
    switch (series) {
        case SieveSeries::astm:
            return opening_among(astm_sieves, number);
        case SieveSeries::tyler:
            return opening_among(tyler_sieves, number);
        case SieveSeries::british:
            break;
    }
    return opening_among(british_sieves, number);
}

std::optional<double> inch_sieve_opening(double inches) {
    return opening_among(inch_sieves, inches);
}

double phi_size(double phi) {
    return 1000 * std::exp2(-phi);
}

}  // namespace grainsweep::campaign
