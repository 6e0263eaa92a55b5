#pragma once
/// Texts of --help: examples. That on methods is made in method_option.hpp.
namespace drev::app {

inline constexpr const char* kMainExamples =
    "Examples:\n"
    "  drev list                          the models\n"
    "  drev list camshaft                 its parameters and channels\n"
    "  drev modes camshaft                its natural frequencies\n"
    "  drev sweep my.toml --speeds 300:10:1800   its steady vibration by orders, and its criticals\n"
    "  drev run camshaft                  5 s, with gear drive and backlash\n"
    "  drev run camshaft --report a.html  its report, a page for any browser\n"
    "  drev chart camshaft                which method suits it, measured\n"
    "  drev study                         the source's studies repeated, and which of their results stand\n"
    "  drev advise camshaft               the simplest model that a figure needs, measured\n"
    "  drev optimise camshaft ...         the parameters that make a figure least\n"
    "  drev export camshaft --out my.toml the same as a file, to be changed\n"
    "  drev check my.toml                 what is wrong with it, if anything\n"
    "  drev run my.toml                   a file stands wherever a model does\n";

inline constexpr const char* kRunExamples =
    "Examples:\n"
    "  drev run camshaft\n"
    "  drev run camshaft --set cylinders=6 --set drive=held damping=case_2\n"
    "  drev run camshaft --out result --record end.angle_rad,mesh_1.force_N --every 0.001\n"
    "  drev run camshaft --report camshaft.html\n"
    "  drev run camshaft --method exact --set duration_s=1\n"
    "  drev run two_mass_backlash --accuracy 1e-6\n"
    "  drev run two_mass_backlash --method hht:0.1 --step 0.001 --json\n"
    "  drev run gear_drive --method sdirk4 --tolerance 1e-4\n"
    "  drev run trains/ my.toml camshaft --out results\n"
    "  drev run camshaft --vary backlash_mm=0:0.1:0.5 --vary drive=gears,held --out results\n"
    "  drev run camshaft --vary backlash_mm=0:0.001:0.5 --step 1e-5 --table --out results\n"
    "  drev run camshaft --vary 'backlash_mm=normal(0.15,0.02)' --sample lhs:1000 --step 1e-5 --out results\n"
    "  mpirun -n 8 drev run camshaft --vary engine_rpm=600:0.1:800 --step 1e-5 --out results --resume\n"
    "  drev run my.toml --plugin build/libmine.so\n"
    "\n"
    "Several models, the model files *.toml of a directory, and all combinations of --vary run side by\n"
    "side, each in a process of its own with the same options. DIR/NAME has the results of each,\n"
    "DIR/runs.csv the figures of all, DIR/runs.json all summaries. A run that fails stops no other one;\n"
    "the exit code is that of the failed runs, or 1 if they differ. Files of a\n"
    "directory that have no format at their top, or that another one includes, are not run.\n"
    "\n"
    "--table keeps a row of figures of each variant, in DIR/variants.h5: constant steps of eight variants\n"
    "in lockstep, other methods one by one, over all processors or the ranks of MPI, with the same bytes.\n"
    "Finished variants are on the disk; --resume continues a study where it ended, and refuses another one.\n"
    "--report draws histograms, figures over parameters and Sobol indices.\n"
    "\n"
    "--accuracy runs the model at one tolerance or step, then at tighter ones, and takes the\n"
    "differences as the errors; where small differences grow too fast for that, figures are\n"
    "statistics with their 95 % confidence intervals. history.csv is of one more run at the tightest.\n"
    "\n"
    "history.csv: time_s, then the channels in the order asked for, at the times 0, 1, 2, ... "
    "times\n"
    "--every, with 17 significant digits. A channel is NODE.angle_rad, NODE.speed_rad_per_s,\n"
    "NODE.position_m, NODE.velocity_m_per_s, ELEMENT.torque_Nm, ELEMENT.force_N or\n"
    "NODE-NODE.twist_rad; angles are deviations from nominal motion. A run that is interrupted or\n"
    "fails leaves history.partial.csv and summary.partial.json instead.\n";

inline constexpr const char* kModesExamples =
    "Examples:\n"
    "  drev modes camshaft\n"
    "  drev modes camshaft --set drive=free --count 5 --json\n"
    "  drev modes gear_drive --contact open\n"
    "  drev modes camshaft --damped --json\n";

inline constexpr const char* kSweepExamples =
    "Examples:\n"
    "  drev sweep engine.toml --speeds 300:10:1800\n"
    "  drev sweep engine.toml --speeds 800:10:2600 --orders 0.5:0.5:12 --out result\n"
    "  drev sweep camshaft --set drive=held --speeds 300:10:900 --orders 1:1:40 --json\n"
    "  drev sweep geared.toml --speeds 300:10:1800 --contact closed --balance generator\n"
    "  drev sweep gear_pair.toml --speeds 2000:50:4000 --out result\n"
    "\n"
    "The output names the reference shaft, whose speeds these are: of camshaft with drive=held the "
    "camshaft,\n"
    "not the engine.\n"
    "\n"
    "Each section has half range, maximum and minimum of the sum of all orders with their phases over the\n"
    "whole cycle, mean, twist, heat; amplitude and phase of each order with --json and --out. Peaks between\n"
    "the speeds are found. Models with contacts: curves of periodic motions through their folds, which of\n"
    "them are stable, where the train jumps. docs/sweep.md has the equations and examples.\n";

inline constexpr const char* kCampbellExamples =
    "Examples:\n"
    "  drev campbell engine.toml --speeds 300:10:1800\n"
    "  drev campbell engine.toml --speeds 300,1800 --orders 1,2,4,6 --out result --json\n"
    "\n"
    "relative: the mode's own part of that amplitude, divided by the largest own part of all criticals.\n";

inline constexpr const char* kClassExamples =
    "Examples:\n"
    "  drev class genset.toml --speeds 600:10:1800\n"
    "  drev class genset.toml --speeds 600:10:1800 --report tvc.pdf --out result\n"
    "\n"
    "The limits of sections are given in the model file, [class]: docs/class_report.md.\n";

inline constexpr const char* kShaftExamples =
    "Examples:\n"
    "  drev shaft camshaft_drawing.toml\n"
    "  drev shaft camshaft_drawing.toml --report shaft.html\n"
    "\n"
    "A shaft by its contour is an element of type contour_shaft: docs/shafts.md.\n";

inline constexpr const char* kImportExamples =
    "Examples:\n"
    "  drev import assembly.json --out train.toml\n"
    "  drev import mass_elastic.csv --out train.toml\n"
    "\n"
    "Standard error and the file's note say what could not be taken over.\n";

inline constexpr const char* kGearExamples =
    "Examples:\n"
    "  drev gear models/camshaft_gears/camshaft_gears.toml\n"
    "  drev gear pair.toml --report pair.html\n";

inline constexpr const char* kChartExamples =
    "Examples:\n"
    "  drev chart camshaft --set drive=held\n"
    "  drev chart two_mass_backlash --out result\n"
    "  drev chart gear_drive --methods exact average_acceleration hht:0.1 --limit 5\n"
    "\n"
    "Errors are relative to the largest value and to a reference that a second method checks.\n";

inline constexpr const char* kAdviseExamples =
    "Examples:\n"
    "  drev advise camshaft --set duration_s=0.5\n"
    "  drev advise camshaft --for 'steady peak torque' --within 5%\n"
    "  drev advise gear_drive --for mesh_1.force_N --within 0.01 --json\n"
    "\n"
    "FIGURE is the largest |value| over the run of the model's deflection, of its torques, or of one\n"
    "CHANNEL; with 'steady' before it, over the last turns. Simpler models are tried, from the gear\n"
    "held to the full model without one part; each is measured against the full one, and the errors of\n"
    "both figures count against it. cost: processor time over that of the full model.\n";

inline constexpr const char* kOptimiseExamples =
    "Examples:\n"
    "  drev optimise gear_drive --vary 'backlash_mm=uniform(0.05,0.3)' --minimise max_mesh_force_N\n"
    "  drev optimise camshaft --set drive=held cylinders=6 --vary 'firing_order=orders(6)' \\\n"
    "    --minimise deflection_deg --start periodic --duration 0.16\n"
    "\n"
    "If there are no more combinations than --variants, all are computed, and the best is certain.\n"
    "Otherwise a quarter of the variants is a Latin hypercube and the rest a search from its best by\n"
    "NLopt (ESCH for values and orders, Subplex for uniform parameters). The same seed gives the same.\n";

inline constexpr const char* kReportExamples =
    "Examples:\n"
    "  drev report result --out result.pdf\n"
    "  drev report before after --out compared.html\n"
    "  drev report --class genset.toml --speeds 600:10:1800 --out tvc.pdf\n";

inline constexpr const char* kListExamples =
    "Examples:\n"
    "  drev list\n"
    "  drev list camshaft\n"
    "  drev list camshaft --set cylinders=6 --json\n"
    "  drev list my.toml\n"
    "  drev list --elements --plugin build/libmine.so\n";

inline constexpr const char* kCheckExamples =
    "Examples:\n"
    "  drev check drive.toml\n"
    "  drev check drive.toml --set backlash_mm=0.3\n"
    "\n"
    "Every fault is listed with file, line and column; exit code 2 if there is one. The model is built\n"
    "for [run] and for each run named in it; --run NAME checks one. What drev run --out would refuse\n"
    "before it starts is a fault, too: intervals, and constant steps above the limit of stability.\n"
    "docs/model_file.md describes the format.\n";

inline constexpr const char* kExportExamples =
    "Examples:\n"
    "  drev export two_inertia\n"
    "  drev export camshaft --set cylinders=6 --out camshaft_6.toml\n"
    "  drev export drive.toml --fmu drive.fmu --torque load --record load.actual_speed_rad_per_s\n"
    "\n"
    "The file holds the model as the parameters make it, in SI units with every digit: running it gives\n"
    "the same results to the last bit.\n";

inline constexpr const char* kStudyExamples =
    "Examples:\n"
    "  drev study --out result\n"
    "  drev study --only held,gear_drive\n"
    "\n"
    "Takes about a minute on two processors. Published values, drev's at the source's step of 1 ms and\n"
    "converged ones with errors are in DIR/study.md; docs/study.md was made like this.\n";

}  // namespace drev::app
