// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/commands.h"

#include <iostream>

int main(int argc, char** argv) {
    hone::cli::ConformanceKit kit;
#ifdef HONE_SELFTEST
    kit = hone::test::runConformance;
#endif
    return hone::cli::runCommandLine(argc, argv, std::cout, std::cerr, kit);
}
