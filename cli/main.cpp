// SPDX-License-Identifier: Apache-2.0
#include "hone/cli/commands.h"

#include <iostream>

int main(int argc, char** argv) {
    return hone::cli::runCommandLine(argc, argv, std::cout, std::cerr);
}
