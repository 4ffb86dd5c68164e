// The search for leaks comes after EGL has unloaded its driver, and with it the pointers to what that keeps.
#pragma once

#ifdef __SANITIZE_ADDRESS__
#include <dlfcn.h>
#include <link.h>

#include <string>
#include <vector>
#endif

namespace splatcut::testing {

// Call while a context lives. Without the address sanitizer: nothing.
inline void keep_drivers_loaded() {
#ifdef __SANITIZE_ADDRESS__
  std::vector<std::string> names;
  const auto note = [](dl_phdr_info* library, std::size_t, void* all) {
    static_cast<std::vector<std::string>*>(all)->push_back(library->dlpi_name);
    return 0;
  };
  dl_iterate_phdr(note, &names);
  for (const std::string& name : names)
    if (!name.empty()) dlopen(name.c_str(), RTLD_LAZY | RTLD_NOLOAD | RTLD_NODELETE);
#endif
}

}  // namespace splatcut::testing
