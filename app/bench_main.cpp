// The program that `cairn bench` runs.
#include "app/command_line.h"

int main(int argc, char** argv) {
    return cairn::app::run_command(argc, argv, cairn::app::add_bench);
}
