// What a command reads is not written over by the same command, whatever was said about overwriting.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

namespace splatcut {

// Whether two names are those of one file that is there, by device and inode.
bool same_file(const std::filesystem::path& a, const std::filesystem::path& b);

// Throws Error where `output`, a file or a folder, is one of the inputs, a folder that holds one, or a file
// in an input that is a folder, and where an input has the name under which AtomicFile writes the output
// first. Files are told apart by device and inode, so that links do not hide them.
// Inputs that are empty or not there, and outputs that are not there, pipes or devices, are nothing to lose.
void refuse_written_inputs(const std::filesystem::path& output,
                           const std::vector<std::filesystem::path>& inputs);

// Throws Error where a picture would be written under the ending of a scene.
void refuse_scene_name(const std::filesystem::path& picture);
// The same for a PNG, also of other kinds of pictures.
void refuse_name_of_png(const std::filesystem::path& picture);

}  // namespace splatcut
