// What tells the one who waits that a part of a loop is done; see cmake/compile_options.cmake.
#include <tbb/parallel_for.h>

template void tbb::detail::d1::fold_tree<tbb::detail::d1::tree_node>(tbb::detail::d1::node*,
                                                                     const tbb::detail::d1::execution_data&);
