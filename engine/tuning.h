/// Tuned numbers of a step. Each has its unit and what it trades; the experiment that set it is in
/// perf/tried.md, and perf/ablation halves, doubles and disables each.
#pragma once

#include <cstddef>
#include <cstdint>

namespace weft::tuning {

/// The error of an iteration falls if it comes below the share `fall` of the least one so far. The
/// iteration has stalled after more than `most` successive times without that.
struct Patience {
  double fall;
  int most;
};

/// Relaxation factor of a correction. At 1 a woven sheet of 41 x 41 gains 0.9 J in a second in 400
/// substeps a frame; at 0.8 it gains none in 1600. A smaller factor makes softer constraints.
inline constexpr double kOmega = 0.8;
/// In substeps: the least time constant of damping that triangles of fabric may have, if they are
/// stiffer than a sweep resolves. A sweep leaves (1 + time) times what it leaves of a law that is
/// not damped.
inline constexpr double kLeastDamping = 0.5;
/// Local passes look at a constraint whose strain exceeds this share of the tolerance. The rest is
/// margin for what corrections of its neighbours add.
inline constexpr double kLocalShare = 0.99;
/// The share of the tolerance to which mending, local passes and sweeps beyond the first of a
/// substep, takes what is out of it (sweeps after the last substep take it all the way). Less makes
/// fewer visits, each of which moves more: cloth that is mended in every substep does not come to
/// rest.
inline constexpr double kMended = 0.8;
/// s. So often it is looked for what may meet a body: a search costs a tenth of a substep, and what
/// lies between two of them makes for more pairs. Beside meshes, where it is verified as often that
/// nothing went through another, twice as much takes 0.6 times as long and misses contacts.
inline constexpr double kContactInterval = 2e-3;
/// In thicknesses: no vertex of a body takes a longer way in such an interval.
inline constexpr double kMeshWay = 5;
/// m/s^2: what lies still speeds up by no more, mostly. Beside a single mesh an interval lasts till
/// it may have led out of kContactSpare thicknesses (7.7 ms at 1 mm), unless cloth and mesh come
/// nearer by so many thicknesses before. At 2 m/s^2 cloth that falls by 2 mm slides by 0.6 mm. With
/// 5 thicknesses a sheet that slides off a ball of triangles misses 15 of 1,680 frames, with 2, 1
/// and 0.5, and in intervals of 2 ms, 8 or 9.
inline constexpr double kCalmAcceleration = 10;
inline constexpr double kCalmWay = 2;
/// So often a sweep pushes apart all pairs of cloth and meshes that touch, one after the other:
/// what pushes a particle last undoes what others did. A sheet over the edge of a knife is 0.3 mm
/// too deep with one round, 0.13 with two, 0.05 with three, 0.02 with four.
inline constexpr int kMeshRounds = 3;
/// Further turns of corners of bodies beside faces of the cloth, while they push by more than the
/// second number (m). Where two triangles close over a sharp cone 199 of 240 frames miss without
/// turns, 15 with 3, 4 with 16, 1 with 32, none with 96. Where bodies overlap turns may take as
/// long as all other contact.
inline constexpr int kCornerTurns = 96;
inline constexpr double kCornerPush = 5e-5;
/// In ways that a particle is predicted to take until the next search: what it may go beyond.
inline constexpr double kContactReach = 0.5;
/// Rounds of a sweep over contacts with bodies that move by themselves, at most; they end where one
/// changes less than the second share of what the first did.
inline constexpr int kFreeRounds = 50;
inline constexpr double kFreeLeft = 1e-3;
/// Turns of these contacts and of local passes, at most.
inline constexpr int kFreeTurns = 8;
/// In the shortest edges of a particle: it is expected to go beyond its straight way by no more,
/// since its neighbours hold it. A cape that flutters at 20 m/s takes 1.5 times as long with 0.5; a
/// sleeve on an elbow 1.3 times with 0.1.
inline constexpr double kContactStray = 0.25;
/// The same in thicknesses, beside meshes: pairs that rest on each other are near in any case.
inline constexpr double kContactSpare = 0.3;
/// Three limits of pairs beside meshes that may come to touch within an interval: edges face each
/// other within the first share of their lengths past their ends; neighbours stand out by no more
/// than the second, a sine; or the pair passes by more than the third share of its distance.
/// Other pairs are left to their neighbours, and to the verification.
inline constexpr double kContactBeyond = 0.2, kContactLean = 0.6, kContactPassing = 0.5;
/// In thicknesses: the margin of boxes that hold points until a step ends. Fluttering cloth leaves
/// them, and its candidates are renewed. While positions are projected boxes of an interval have it
/// in place of kContactSpare, since nothing tells where points go: the first frame of `outfit` 40
/// has 223 intervals in place of 266.
inline constexpr double kContactWideSpare = 0.5;
/// The same while bodies stand, and positions are projected.
inline constexpr double kContactStandingSpare = 1.5;
/// In reaches of an interval: what tubes hold beyond the way of a particle. It is about time and
/// the order of pairs alone (perf/tried.md has all of these ablations): with 3 the tunic of a body
/// that walks leaves its tubes more often.
inline constexpr double kContactWideReach = 5;
/// Tubes of cloth that touches itself hold more, so that particles that speed up seldom leave
/// theirs: this part of the shortest edge of a particle, or of its way until the step ends, or the
/// way that this acceleration (m/s^2) makes in that time. A falling sheet of 20 x 20 is renewed six
/// times a frame otherwise, and takes 1.6 times as long.
inline constexpr double kTubeOfEdge = 0.1, kTubeOfWay = 2, kTubeAcceleration = 40;
/// In thicknesses, and what the cloth may go in half of a step: bodies that are farther from it
/// do not take it along in this step.
inline constexpr double kContactRegion = 4;
/// m: places are floats from an origin, which is a multiple of this. A finer grid moves the origin
/// more often, and candidates are looked for anew.
inline constexpr double kContactGrid = 2;
/// Pairs of a block of 16 beside meshes: where so many are awake all are measured, which is as fast
/// as to gather these. It is about time alone.
inline constexpr int kAwakeAtOnce = 8;
/// m: features that are no farther apart are on no side of each other. At 1e-15 cloth that begins
/// exactly on a mesh does not come to lie on it; 1e-7 changes nothing.
inline constexpr double kTouching = 1e-9;
/// m, by which layers that begin in one plane are moved apart, one beside the other. At 1e-7 floats
/// hardly tell them apart, and 19 pairs of two sheets that slide over each other are stopped in the
/// first frame; at 1e-6 and 1e-5 none.
inline constexpr double kCoplanarWay = 1e-6;
/// m: features that were farther apart come no nearer than that, and triangles that crossed have
/// come apart when they are. Without it two layers that a floor bears come to lie in one plane, a
/// tenth of their distance each interval, and one through the other from there (300 loose pieces in
/// a box).
inline constexpr double kStaysApart = 1e-8;
/// m/s, at which triangles that cross are pulled apart (untangling.h). Pockets that begin tilted
/// through a shirt, held on both sides of it, hang on at 0.05 and 0.1 and come out at 0.2, in 0.4
/// s.
inline constexpr double kUntanglingSpeed = 0.2;
/// s, in which it comes to that speed: particles beside a contour are pulled by five times their
/// weight. It is not shorter than the longest substep, so that the length of substeps does not
/// count.
inline constexpr double kUntanglingTime = 4e-3;
/// The sine by which a neighbour may stand out of a pair that pushes. At 0 cloth on a knife edge
/// is 0.4 mm too deep, at 0.04 a sheet does not hang over a ball of triangles as over a ball, and
/// without a limit a sheet does not glide over triangles as over a plane.
inline constexpr double kTouchLean = 0.02;
/// In thicknesses: features that are nearer where their points lie in a plane went through each
/// other there; and the steps in which that moment is found. Where any
/// change of side counts `mesh_spins` reports what is not true; at 0 nothing fails. With one step
/// two hard cases miss a frame, with 4 and 8 none.
inline constexpr double kTogether = 0.01;
inline constexpr int kPlaneSteps = 16;
/// In the largest inverse mass of a pair: the least that counts. If a particle has the part w in
/// the nearest point of an otherwise fixed feature, it would be thrown 1 / w times as far as the
/// pair is deep: at 0 the tip of a body throws a sheet that it touches beside its pins.
inline constexpr double kLeastTouchWeight = 0.05;
/// In thicknesses: what is nearer when an interval is over, and was not expected, is no rounding;
/// and the rounds in which such pairs are corrected before the rest is verified. Without either two
/// hard cases are 0.3 and 0.5 mm too deep and do not say so; with one round none.
inline constexpr double kLate = 0.99;
inline constexpr int kLateRounds = 3;
/// A share of the thickness, or of the first distance if that is less: features that come nearer
/// meet. The search for the time of meeting takes steps of the next share of the distance left, at
/// most so many. With half of the distance, or 10 steps, a sheet does not glide over triangles as
/// over a plane; with a hundredth, 50 steps, and shares of 0.45 and 0.99 all tests pass.
inline constexpr double kMeetingLeft = 0.1;
inline constexpr double kMeetingStep = 0.9;
inline constexpr int kMeetingSteps = 200;
/// Rounds of impacts of pairs that went through each other, and then of rigid zones. Without
/// impacts `mesh_appears_in_cloth` gains 0.1 J; with four rounds it does not. Without zones
/// `layers_in_a_ball_into_a_corner` ends with three crossings.
inline constexpr int kImpactRounds = 8;
inline constexpr int kZoneRounds = 12;
/// The same of cloth that touches itself: after kZoneRounds zones grow by their neighbours, too.
inline constexpr int kClothZoneRounds = 60;
/// The share that features of a cloth keep of a distance at rest below its thickness. At 1 each
/// fold of a fine mesh, and each shear, would be a contact.
inline constexpr double kRestDistance = 0.7;
/// So often a sweep visits contacts. A layer that should slide at 12.4 mm/s slides at 13.4 with two
/// rounds, at 12.5 with four and at 11.6 with eight, by which a stack takes 1.3 times as long.
inline constexpr int kContactRounds = 4;
/// The share of a missing thickness that a pair regains in a substep. With 0.05 a sheet
/// that folds on a floor gains 0.1 % of its energy; without it pressed pairs stay
/// pressed.
inline constexpr double kContactRecovery = 0.02;
/// The cosine of the angle at which bodies are against each other, so that what lies between them
/// is held by both, and not pressed out. A ball of triangles that presses a sheet 6 cm into a box
/// of triangles at 240 Hz: with 0.3, 0.4, 0.45, 0.5, 0.7 it moves by 0.5, 0.4, 0.6, 98, 200 m/s.
inline constexpr double kAgainst = 0.4;
/// Compliance of a yarn's constraints in a sweep, relative to the diagonal of its matrix. That of a
/// yarn that two fixed particles hold is singular where it is straight: a smaller compliance lifts
/// banners, a larger one is softer, and farther from the true motion. All other yarns have only
/// what keeps rounding in bounds: a sweep carries a load along 1 / sqrt(2 compliance) constraints.
inline constexpr double kHeldCompliance = 3e-3;
inline constexpr double kCompliance = 1e-4;
/// The same of a linkage, which is solved in double.
inline constexpr double kLinkageCompliance = 1e-9;
/// A linkage is solved again where its tensions change by more than this share of the largest, or
/// where another rope is taut, so many times at most. At a half a chain of 200 links under 100
/// times its weight shakes until it is out of tolerance; at a tenth it keeps 0.9996 of its swing.
inline constexpr double kLinkageTension = 0.1;
inline constexpr int kLinkageRounds = 8;
/// A rope was slack where the square of its length was less by this share: a taut one has only
/// rounding. A chain that a pin drags by jerks bounces without (`engine/step/carry`).
inline constexpr double kLinkageSlack = 1e-6;
/// s. No substep is longer. It bounds the error of motion where nothing hangs on a pin.
inline constexpr double kLongestSubstep = 0.005;
/// A substep is no longer than this part of the time in which a falling particle passes the length
/// of a constraint. In about that time a fold that runs through a yarn turns a constraint over.
inline constexpr double kPassing = 0.7;
/// The largest automatic number of substeps of a step.
inline constexpr int kMostSubsteps = 1024;
/// A share of the error of motion that is asked for: after frames with a smaller error the next
/// ones have fewer substeps. A larger share changes their number more often, a smaller one pays for
/// more than was asked for.
inline constexpr double kMotionSpare = 0.3;
/// More substeps are of use for the motion while its error is this many times what rounding makes
/// of it.
inline constexpr double kOverRounding = 4;
/// Yarns are blocks if they have this many constraints, in rigid sheets on average. Random
/// triangles make yarns of 3 or 4, a woven sheet of n x n particles makes yarns of n - 1.
inline constexpr double kLeastLinks = 8;
/// A spring that is so many times as soft as those that cross it is no part of a yarn. Diagonals of
/// the cells of fabrics are 20 to 200 times as soft as warp and weft.
inline constexpr double kSofter = 8;
/// Substeps between two renewals of the base. Displacements are rounded to a 2^-24 part of what a
/// particle moves in between.
inline constexpr int kRenewal = 16;
/// s, that a fabric which was put somewhere has to give way, from rest, again and again; then the
/// longest substep, in which stiff fabric comes to rest. A swing with the angular frequency w keeps
/// 1 / (1 + (w h)^2) of its stretch each time h. A longer time loses more of what the fabric
/// carried (perf/tried.md).
inline constexpr double kPlacing = 1. / 60;
/// Patience with the speed of its fastest particle. Contradictory cloth, as around a body that it
/// is too small for, never rests.
inline constexpr Patience kPlacingPatience{0.9, 8};
/// m/s, that misplaced fabric reaches in the longest substep: ten times what falls does. Cloth that
/// moves and is put back as it was must not count as misplaced.
inline constexpr double kMisplacedSpeed = 0.5;
/// m/s, the speed of its fastest particle at which it is left, below which its start is not seen.
inline constexpr double kPlacedSpeed = 0.005;
/// Bending is solved for n substeps at once while (n h)^2 times a bound of the stiffest swing
/// (BendingRows::stiffest) is at most kBendingGroup, and n at most kLongestGroup
/// (engine/solvers/small_steps/bending_frame.h). At 2 a damped sheet that flies is torn
/// about, though impulses of a swing by itself are stable to 4. Without groups a skirt takes 1.6
/// times as long (perf/tried.md).
inline constexpr double kBendingGroup = 1;
inline constexpr int kLongestGroup = 8;
/// The stiffness that a substep resolves of the part of a fold's force by which its normal turns
/// (kernels/reference/bending.h), over that of a swing. At 1 card of 1 N m still moved by 4 degrees
/// after two seconds; at 0 pleats that fly gain 1 % of their spin in a second.
inline constexpr double kResolvedTurning = 0.3;
/// Automatic substeps are no longer than so many radians of the swing of a hinge that is folded at
/// rest, over the square of the sine of half its angle (engine/solvers/small_steps/fold_length.h).
/// Pleats of 60 to 140 degrees at cells of 2.5 and 5 mm, of 3e-5 to 3e-4 N m, come to rest at their
/// angle up to 8; at 10 one is off by 1 %.
inline constexpr double kFoldTurn = 7;
/// Damping adds to the stiffness of bending in a substep at most this share of it, or where that is
/// more this share of M / (b h)^2. More damps small folds as asked for; less takes fewer steps.
inline constexpr double kBendingDamping = 0.5;
/// The share of a force that bending is solved to, over the tolerance, and the largest tolerance
/// that it is taken from. A solution begins with the last one: so what is left acts the same way
/// in many substeps, as a force from outside would. At a share of 1 a crumpled plate of 10 N m that
/// has 190 J came to 2,700, and a strip that flies is pushed four times as far as a test allows. By
/// a tolerance of 1000 % itself cloth would not bend at all (perf/tried.md).
inline constexpr double kBendingPart = 0.1;
inline constexpr double kLoosestBending = 0.05;
/// Where floats go no further a solution ends all the same, and tells what it has left. From 10 to
/// 800 no bit of `hang` and of strips of all materials changes; with 3 `hang` misses frames.
inline constexpr int kMostBendingSteps = 200;
/// The sine of the angle between the line of an element's ends and that from its middle to a
/// particle that tells how it turns about that line. At 0 a strip that flies loses ten times as
/// much of its spin as tests allow; from 0.25 to 0.95 all tests of bending pass.
inline constexpr double kLeastSineBeside = 0.5;
/// Steps along the diagonal, over the root of n (b h)^2 K_ii / m_i in the mean (4 to 5 were
/// measured of grids and irregular triangles). A factorisation is made where that is at least
/// kLeastFactored, of at most kMostFactored particles, and where it is estimated to take less time
/// (ns): for each row and step, and for each value of the factor.
inline constexpr double kBendingStepsPerRoot = 4.5;
inline constexpr double kLeastFactored = 12;
inline constexpr std::size_t kMostFactored = 100000;
inline constexpr double kBendingStepTime = 13;
inline constexpr double kFactorTime = 4;
/// While more than this share of all constraints is out of tolerance a substep sweeps again, which
/// is cheaper than local passes.
inline constexpr double kManyOut = 0.02;
/// Substeps of fabric are shorter in the next frame where corrections of the last one's errors
/// take more than the first share of the time of all sweeps, and longer below the second
/// (perf/tried.md).
inline constexpr double kMuchMended = 0.5;
inline constexpr double kLittleMended = 0.04;
/// In tolerances. A frame is done again in more substeps where its last sweep has left a law more
/// than the first, or more than the second after corrections that took more than this share of the
/// time of all sweeps. At 12 in place of 8 a ball falls through a sheet, 6 costs a flag of silk
/// 1.46 times the time; at a share of 0.5 a ball on stiff cloth rises by 13 cm too high
/// (perf/tried.md).
inline constexpr double kMostLeft = 8;
inline constexpr double kMostLeftUnderLoad = 3;
inline constexpr double kLoadedShare = 0.25;
/// In tolerances: where the error of longer substeps was predicted to be less, and they had to
/// become shorter, longer ones are not blamed. At 0 a patch on a pinned sheet remains in 5 substeps
/// at 240 Hz, now in 3; at 0.5 it changes back and forth for three seconds at 60 Hz
/// (perf/tried.md).
inline constexpr double kLeastBlamed = 0.125;
/// s. Sweeps become stiffer by e in no less than this time. At once, a sheet that falls on a taut
/// cord flies up by 28 cm; by 2.4 cm at 6 ms, 1.7 at 7 and 1.5 at 9. Above 7 ms cloth that a ball
/// presses deep into a table is too late, and thrown about by 1.7 m/s (perf/tried.md).
inline constexpr double kStiffening = 0.007;
/// s. Energy that the motion loses may come back for about this time, since constraints are
/// springs.
inline constexpr double kSpringTime = 0.1;
/// Pairs of spheres and particles are looked at that may touch in the rest of a frame, while
/// nothing moves faster than kNearbySpare times as fast as now, but none farther apart than
/// kNearbyMost of the largest radius. More finds pairs less often, and more of them.
inline constexpr double kNearbySpare = 1.5;
inline constexpr double kNearbyMost = 0.25;
/// Time of a visit of local passes, over that of a sweep's visit: of a constraint, and of a
/// triangle of fabric (110 ns against 6).
inline constexpr double kLocalVisit = 8;
inline constexpr double kLocalVisitOfTriangle = 20;
/// Where at least as many substeps were given as automatic ones would be: the time beyond their
/// sweeps, in sweeps for each. Less leaves more to later frames; more takes longer.
inline constexpr double kPassesBeyond = 6;
/// The same of contacts: to look at a pair or to visit a contact in lanes, and in double (12 and
/// 300 ns). They count by a share of that where a frame is corrected: all of it would leave a
/// garment in the air that is put on, none of it lets a hopeless one take 20 s.
inline constexpr double kVisitsOfLook = 2;
inline constexpr double kVisitsOfTouch = 50;
inline constexpr double kContactShare = 0.25;
/// The largest number of visits of local passes in a substep and in a round, in units of all
/// constraints. Fewer leave more to later substeps; more are spent in vain on what is
/// contradictory.
inline constexpr int kMostVisits = 32;
/// A frame that is out of tolerance after its last substep goes on for at most so many rounds of a
/// sweep and local passes.
inline constexpr int kMostRounds = 64;
/// Rounds of a frame, and parts of the paper's loop: then the constraints count as contradictory.
inline constexpr Patience kRoundPatience{0.999, 16};

/// The share of its velocity relative to the air that cloth across the wind may lose between two
/// looks at the air (engine/step/air.h). A flag flutters too fast where it is larger; looks take
/// time.
inline constexpr double kAirShare = 0.3;
/// A substep is no longer than this over the rate at which the air turns cells (AirPace). Longer
/// ones damp what flutters: a flag of silk in 20 m/s, 60 Hz, has 0.88 of its speed at 0.25, 0.83 at
/// 0.3 and 0.73 without.
inline constexpr double kAirTurn = 0.22;

/// A share of the volume at which a gas has its given pressure: where it is pressed to less, its
/// pressure grows no more. A bag that lies flat would else begin with an infinite one.
inline constexpr double kLeastOfGas = 1e-3;
/// s, and a share of the mean length of constraints. Cloth rests of which no particle comes farther
/// than that in that time: 1e-4 m/s with constraints of 5 cm. Rounding moves particles of sheets
/// that rest by a tenth of it. A longer time lets fewer slow swings fall asleep at a turning point.
inline constexpr double kRestTime = 0.5;
inline constexpr double kRestShare = 1e-3;

// ----------------------------------------------------------------------- the choice of a solver

/// The largest share of constraints that close a loop in chains, trees and bridges. In a bridge a
/// third do, in a grid half.
inline constexpr double kChainLoops = 0.4;
/// The tightest tolerance at which small steps are chosen.
inline constexpr double kLeastTolerance = 1e-3;
/// Ratios of masses: up to the first small steps are chosen, and the direct solver keeps to
/// Newton's method; from the second on the direct solver stands by behind yarns.
inline constexpr double kNearlyEqualMasses = 100;
inline constexpr double kUnequalMasses = 1e4;
/// A free sphere is light if it has at most this many times the mass of a particle that it may
/// meet: small steps take long to pass on the impact of a heavier one.
inline constexpr double kLightSphere = 10;

// -------------------------------------------------------------------------------- the control

/// Slots of a particle that make another thread worth its meetings: two threads gain nothing at
/// 1,600 particles, and 1.7 times at 10,000.
inline constexpr std::size_t kLeastSlotsPerThread = 1000;
/// A substep is tried in up to 2^kMostDoublings parts, a frame of fabric in so many times its own.
inline constexpr int kMostDoublings = 4;
/// The part of a doubling by which each step without a rejected attempt comes back to fewer, longer
/// substeps.
inline constexpr double kCoarsening = 0.125;
/// Strain that one substep of a motion without constraints may reach, and that strain times the
/// particles of its yarn. Less means more substeps; more means substeps that solvers give up.
struct Bend {
  double most;
  double longest;
};
inline constexpr Bend kUsualBend{0.06, 3};
/// Scheme rattle must resolve the motion: with half as many substeps half of them fall back.
inline constexpr Bend kRattleBend{0.01, 1.5};
/// 1/rad, by which an angular frequency times the substep is less than 1, and the ratio of masses
/// from which on a load decides about substeps.
inline constexpr double kLoad = 0.7;
inline constexpr double kLeastLoad = 1000;
/// Iterations of a step for each automatic substep by yarns, at least.
inline constexpr int kLeastIterations = 8;
/// Passes of the paper's loop between two looks at the true errors: more than steps that go well
/// ever need.
inline constexpr int kPassesBetweenLooks = 4096;

// --------------------------------------------------------------------------------- the energy

/// Gain of energy, as a share of what the impulses are worth, up to which a substep is left alone.
inline constexpr double kMostGain = 0.5;
/// Gain of energy, as a share of what the impulses of its velocity loop are worth, from which on a
/// substep by scheme rattle is rejected; and as a share of the kinetic energy, since positions are
/// rounded.
inline constexpr double kRattleGain = 0.1;
inline constexpr double kEnergyRounding = 1e-9;

// ---------------------------------------------------------------------------- the yarn solver

/// The strain to reach where the tolerance is larger, and with scheme rattle, whose check of the
/// energy does not tell noise from a gain. Less costs iterations; more is noise for later steps.
inline constexpr double kYarnGoal = 0.003;
inline constexpr double kRattleGoal = 1e-4;
/// Taut spans are given the lengths of the prediction up to this share of the permitted strain.
/// More leaves the solver less margin; less takes their sag away.
inline constexpr double kHeldShare = 0.8;
/// A Newton step follows a sweep that leaves more than this share of the error, if the strain is
/// below kNewtonStrain: with larger strains directions turn too far for a linear system.
inline constexpr double kSlowSweep = 0.8;
inline constexpr double kNewtonStrain = 0.025;
/// Where one more sweep is not expected to reach this multiple of the goal, a second one follows
/// before errors are measured, which takes half as long as a sweep.
inline constexpr double kFarFromGoal = 2;
/// A block whose strain exceeds this share of the goal after a solve is solved again at once, while
/// it is in the caches, but at most kMostBlockSolves times in a sweep. A smaller share means fewer
/// sweeps, and more solves of blocks that their neighbours move again.
inline constexpr double kBlockShare = 0.3;
inline constexpr std::uint32_t kMostBlockSolves = 20;
/// Strain that the rounding of floats hides: blocks are not solved again for less.
inline constexpr double kLeastSeen = 1e-6;
/// Linear systems are solved to this share of the goal, or to the share kForcing of the error that
/// eliminating the first family leaves, in at most kMostSystemIterations. Less costs iterations;
/// more costs Newton steps.
inline constexpr double kSystemShare = 0.5;
inline constexpr double kForcing = 0.2;
inline constexpr int kMostSystemIterations = 300;
/// Velocities that are to be exact are brought to this share of their error.
inline constexpr double kExactVelocity = 0.01;
/// Measurements of the error; and of what others can do instead: errors by scheme rattle, and
/// velocities.
inline constexpr Patience kYarnPatience{0.7, 20};
inline constexpr Patience kShortPatience{0.9, 4};
/// Iterations of a linear system. If it stalls with more than the share kFarBelow of its first
/// residual, its errors contradict each other, and nothing is moved.
inline constexpr Patience kSystemPatience{0.95, 60};
inline constexpr double kFarBelow = 0.3;
/// With scheme rattle, a constraint outside of yarns is not relaxed if the cosine of the angle by
/// which it has turned is less: its impulse would be far larger than its error.
inline constexpr double kLeastCosine = 0.1;
/// Blocks are woven if a family has at least this share of all particles in rows of fours, if this
/// share of the other families' rows is in whole patches, and if the rows of memory have at most
/// kMostLanesPerParticle lanes for each particle. Otherwise quads are at least as fast.
inline constexpr double kLeastWoven = 0.75;
inline constexpr std::size_t kMostLanesPerParticle = 2;
/// A patch is transposed as a whole if each of its lanes has at least this many particles in it.
inline constexpr int kLeastOfPatch = 4;

// -------------------------------------------------------------------------- the direct solver

/// The strain to reach where the tolerance is larger, at the cost of one more solve: more is noise
/// that later steps have to remove.
inline constexpr double kDirectGoal = 1e-5;
/// In units of the tolerance: smaller errors are not solved for. Larger ones within the tolerance
/// are, once, or they would grow until a later step had to remove all of them at once.
inline constexpr double kNegligibleError = 1e-6;
/// Solves. Two or three are usual.
inline constexpr Patience kDirectPatience{0.85, 4};
/// The imbalance that does not count, in units of the tolerance; and the largest share of a motion
/// that impulses may leave unexplained, beyond which it gains energy. Less rejects sheets that whip
/// about in long steps.
inline constexpr double kNegligibleImbalance = 0.1;
inline constexpr double kMostUnexplained = 0.75;
/// Particles with more constraints are bodies, unknowns beside the matrix: in it each would make a
/// dense block. More than kMostBodies bodies take longer than other solvers.
inline constexpr std::size_t kBodyDegree = 64;
inline constexpr std::size_t kMostBodies = 16;
/// Compliance of a constraint at a body, as a share of the inverse masses of its ends. It replaces
/// what is singular; its error is left to the next solve.
inline constexpr double kBodyCompliance = 1e-8;
/// The method with geometric stiffness takes at most kMostStiffSolves solves, and fewer where the
/// values of all factors would exceed kMostStiffWork.
inline constexpr std::size_t kMostStiffSolves = 20000;
inline constexpr std::size_t kMostStiffWork = 100000000;
/// ns: the estimated times of a front, of a value that is assembled or passed on, and of a product.
/// Fronts are merged by them; the optimum is flat.
inline constexpr double kFrontTime = 300;
inline constexpr double kValueTime = 0.6;
inline constexpr double kProductTime = 0.12;

// --------------------------------------------------------------------------------- meshes

/// An edge over a thin triangle of fabric is flipped where that changes the area at rest, or what
/// the material does, by at most this share: a third of what woven cells may be off.
inline constexpr double kMostFabricChange = 0.01;
/// How often the energies that bending stores around particles become means over neighbours, before
/// elements get their factors; and how often all of that is done. More rings leave a sheet stiffer
/// as a whole and its parts less alike (perf/tried.md).
inline constexpr int kBendingRings = 3;
inline constexpr int kBendingSteps = 2;
/// Where the mesh around a particle stores in each direction what it should, to this fraction,
/// elements keep what their areas give them.
inline constexpr double kBendingEven = 1e-3;
/// The largest factor that one step gives an element, and the inverse of the smallest.
inline constexpr double kMostBendingFactor = 10;
/// How strongly the coefficients of factors are held near those of equal factors, relative to the
/// equations that they solve: enough for meshes that have fewer directions than equations.
inline constexpr double kBendingRestraint = 1e-3;
/// How often particles settle in each step of the calibration, and the share of the way that they
/// go: of a Jacobi iteration, which diverges from about 0.7 on.
inline constexpr int kSettlings = 8;
inline constexpr double kSettlingShare = 0.4;
/// Where the mesh around a particle bends in some direction by more than this fraction too much or
/// too little, elements are added. A smaller one makes it more even, and steps slower.
inline constexpr double kBendingUneven = 0.1;
/// The largest share by which a quad whose sides are springs may be softer in shear than its
/// material. A larger one makes more quads of curved grids yarns, which are several times as fast
/// as triangles.
inline constexpr double kWovenError = 0.03;
/// The share of warp or weft that kWovenError is measured by at least. Without it cloth that has no
/// shear would be yarns on exact rectangles alone.
inline constexpr double kFeltShear = 0.01;
/// Sliders of one rail move it under each other, and so do seams that share a particle. They take
/// turns, at most so many in a sweep, until all are within this share of contact_tolerance. More
/// turns take longer. In one turn layers that are sewn one to the next, and hang from the first,
/// sink for ever; with a share of 0.25 their seams close up to 0.1 s too late (perf/tried.md).
inline constexpr int kJointTurns = 16;
inline constexpr double kJointShare = 0.01;
/// A crack goes on away from where it comes from, if the direction across the tension leads there
/// by this share. Else, as where the tension runs along it, both directions are as good.
inline constexpr double kLeastOpening = 0.1;
/// Automatic substeps are no longer than so many radians of the swing of a spring that carries this
/// share of its strength or more: longer ones solve it too soft. Pinned strips tear within 2 % at 2
/// radians, and at 1.03 to 2.5 times their stretch without this (engine/step/tearing.h).
inline constexpr double kTearingTurn = 2;
inline constexpr double kNearStrength = 0.5;
/// Ends of a seam that are nearer than this share of a side are drawn as one. A closed seam holds
/// them far nearer; a larger share draws an open seam as closed.
inline constexpr double kClosedSeam = 0.05;

}  // namespace weft::tuning
