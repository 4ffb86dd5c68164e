// A case that also runs under the sanitizers, with what it stands for there: a reader of files of others, a
// thread of ours. tests/quick_tests.cmake lists what must have such a case.
#pragma once

#include <doctest/doctest.h>

#define QUICK_CASE(label, name) TEST_CASE(name* doctest::test_suite("quick: " label))
