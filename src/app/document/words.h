// Numbers as text for people, written one way everywhere.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

namespace splatcut {

std::string grouped(std::size_t n);         // "92,440"
std::string gaussians_text(std::size_t n);  // "92,440 Gaussians", "1 Gaussian"

// The name that a person knows a scene by: its file's, or its folder's where files of one scene always have
// the same names (meta.json, lod-meta.json). A folder's own name where a folder is given.
std::string scene_name(const std::filesystem::path& scene);

// The folder that tells a scene from others, above those that trainers name alike, and the iteration:
// "garden", "garden/iteration_7000". And the same before the scene's name: "garden/point_cloud.ply",
// "garden".
std::string telling_folder(const std::filesystem::path& scene);
std::string name_in_folder(const std::filesystem::path& scene);
// True for file names that many scenes have: "point_cloud.ply".
bool has_common_name(const std::filesystem::path& scene);

// A length of the scene with three figures: "0.0235", "12.4", "1,250". Scene units.
std::string length_text(float length);
// printf's format for the length where it can be typed, with three figures.
std::string length_format(float length);

// The same with a capital letter, where it stands by itself.
std::string as_sentence(std::string text);

std::string ms_text(double ms);  // "740 ms", "2.4 s"

}  // namespace splatcut
