//! Tests of scenes, results, sweeps and the program, a module for each subject. One program takes less time to build than one for each file, and keeps
//! every core busy until its last test.

mod assembly_command;
mod assembly_gallery;
mod assembly_physics;
mod assembly_scenes;
mod bad_input;
mod beam_theory;
mod beams;
mod choice_commands;
mod command_line;
mod documented_outputs;
mod falling;
mod first_steps;
mod fuzz_corpus;
mod gallery;
mod gallery_physics;
mod identify;
mod infinite_beam;
mod kept_inputs;
mod law_command;
mod model;
mod net_restitution;
mod orbit;
mod own_law;
mod pictures;
mod program;
mod result_file;
mod scene_files;
mod scenes;
mod sensitivity;
mod sweep;
mod trust;
mod uncertainty;
