// --vtk DIR and --frames N: pictures on the way, for the commands that compute a case in this process.
#pragma once

#include "sweep/cli/parser.hpp"
#include "sweep/workers/compute.hpp"

#include <cstdint>
#include <string>

namespace grainsweep::cli {

struct PictureRequest {
    std::string folder;  ///< empty: no pictures
    std::int64_t frames = 50;
};

void declare_pictures(Parser& parser, PictureRequest& request);

/// A camera that fills the folder, none where none is asked for. Throws WrongQuestion on its first frame where the
/// scene shows no particles, store::BrokenWorld where a file cannot be written.
[[nodiscard]] workers::Camera camera(const PictureRequest& request, const std::string& scene);
/// Says which pictures were written, where any were asked for; elsewhere than on standard output where that holds one
/// value for a program.
void say_pictures(const PictureRequest& request, const std::string& scene, bool on_standard_output);

}  // namespace grainsweep::cli
