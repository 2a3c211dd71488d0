// The picture of a drum that photographs and simulations are compared by, and the area in which two differ.
//
// On n x n pixels of side a = 2 R/n, pixel (i, j) from the left and from the bottom:
//
//     mask        X_i^2 + X_j^2 <= 0.6 R^2, X_k = -R + 2 R k/(n - 1)
//     map         V = sum over particles and intervals k of area(pixel and S_k less D_{k+1})/(2 r d_k)
//                     + sum over particles of area(pixel and D_K)/(2 r d_{K-1})
//                 D_k the disc of radius r about the centre in frame k, S_k the convex hull of D_k and D_{k+1}, d_k the
//                 distance of the two centres; half circles are polygons of 16 vertices; d_k = 0 is left out
//     picture     of the map: floor(255 (V - min V)/(max V - min V)), V = 0 outside of the mask; closed 7 x 7; > 10
//                 of shares of time: closed 7 x 7; >= a level
//     cost        a^2 times the number of pixels in which two pictures differ
//
// Source of the definitions: repository ACCES-GranuDrum-Calibration (Positron Imaging Centre, University of
// Birmingham), commit e5c6dd0, after arXiv:2505.02967; written anew here.
#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <vector>

namespace grainsweep::tests {

/// x to the right and z up, m, and the radii, of the same particles in each frame.
struct DrumFrames {
    std::vector<std::vector<std::array<double, 2>>> centres;  ///< frame by frame
    std::vector<double> radius;
};

class DrumPicture {
public:
    DrumPicture(double radius, int pixels);

    [[nodiscard]] double side() const { return side_; }
    [[nodiscard]] std::size_t pixels() const { return mask_.size(); }
    [[nodiscard]] const std::vector<char>& mask() const { return mask_; }

    /// V, row by row from the bottom, over the whole square.
    [[nodiscard]] std::vector<double> map(const DrumFrames& frames) const;
    /// Share of the frames in which any disc hides the pixel's centre.
    [[nodiscard]] std::vector<double> cover(const DrumFrames& frames) const;
    [[nodiscard]] std::vector<char> of_map(std::vector<double> map) const;
    [[nodiscard]] std::vector<char> of_cover(std::vector<double> share, double level) const;
    /// m2, within the mask.
    [[nodiscard]] double difference(const std::vector<char>& a, const std::vector<char>& b) const;
    /// Lines `row,first,length` of black pixels. Throws std::runtime_error where the file is none of that kind.
    [[nodiscard]] std::vector<char> read(const std::filesystem::path& file) const;

private:
    [[nodiscard]] std::vector<double> closed(const std::vector<double>& values) const;

    double radius_, side_;
    int n_;
    std::vector<char> mask_;
};

}  // namespace grainsweep::tests
