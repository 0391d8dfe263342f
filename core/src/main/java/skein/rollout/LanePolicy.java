package skein.rollout;

import static jdk.incubator.vector.VectorOperators.NE;
import static skein.rollout.LaneMath.INTS;
import static skein.rollout.LaneMath.LANES;
import static skein.rollout.LaneMath.SPECIES;
import static skein.rollout.LaneMath.constant;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import skein.policy.ChauffeurEvader;
import skein.policy.LeadPursuit;
import skein.policy.NeuralPolicy;
import skein.policy.PaperEvader;
import skein.policy.PaperPursuer;
import skein.policy.Policy;
import skein.policy.ProportionalNavigation;
import skein.policy.PurePursuit;

/**
 * Policies of one form in many worlds, each with parameters of its own. Their scalar references are
 * the policies of {@code skein.policy}; {@code LanePolicySuite} holds them to those. Mutable: one
 * per kernel and role.
 */
abstract class LanePolicy {
  /** Worlds that decide together: few enough for the first-level cache. A multiple of every lane count. */
  static final int WORLDS = 128;

  private static final FloatVector QUARTER = constant(0.25f),
      MINUS_TWO = constant(-2f),
      ONE = LaneMath.ONE,
      PI = LaneMath.PI;

  // arccos h = √(1 − h) · polynomial on 0…1, error below 2e-8: Abramowitz and Stegun, 4.4.46.
  static final FloatVector ACOS_0 = constant(1.5707963050f),
      ACOS_1 = constant(-0.2145988016f),
      ACOS_2 = constant(0.0889789874f),
      ACOS_3 = constant(-0.0501743046f),
      ACOS_4 = constant(0.0308918810f),
      ACOS_5 = constant(-0.0170881256f),
      ACOS_6 = constant(0.0066700901f),
      ACOS_7 = constant(-0.0012624911f);

  static final FloatVector PER_TURN = constant((float) (0.5 / Math.PI)),
      MINUS_TURN = constant((float) (-2 * Math.PI));

  /** 1.5·2²³: adding it and taking it away leaves a float's nearest integer. */
  static final FloatVector ROUND = constant(12582912f);

  private static final IntVector NO = IntVector.zero(INTS);

  /** How far each world's decided heading is from the one before, by the shorter way, rad. */
  final float[] turned = new float[WORLDS];

  /** The heading commanded last, rad, for policies that integrate it, and the one decided. */
  final float[] heading = new float[WORLDS], newHeading = new float[WORLDS];

  /** Lanes that fly policies of this policy's form; none where no lanes know it. */
  static LanePolicy of(Policy policy) {
    return switch (policy) {
      case PaperPursuer p -> new PaperPursuerLanes();
      case PaperEvader p -> new PaperEvaderLanes();
      case PurePursuit p -> new PurePursuitLanes();
      case ProportionalNavigation p -> new ProportionalNavigationLanes();
      case LeadPursuit p -> new LeadPursuitLanes();
      case ChauffeurEvader p -> new ChauffeurEvaderLanes();
      case NeuralPolicy p -> new NeuralLanes(p.shape());
      default -> null;
    };
  }

  /**
   * What policies share that can fly side by side; null where no lanes know the policy. Two policies
   * of one form are equal in it.
   */
  static Object formOf(Policy policy) {
    return switch (policy) {
      case NeuralPolicy p -> p.shape();
      case PaperPursuer p -> PaperPursuer.class;
      case PaperEvader p -> PaperEvader.class;
      case PurePursuit p -> PurePursuit.class;
      case ProportionalNavigation p -> ProportionalNavigation.class;
      case LeadPursuit p -> LeadPursuit.class;
      case ChauffeurEvader p -> ChauffeurEvader.class;
      default -> null;
    };
  }

  /** Takes the parameters that a world flies by from now on; the policy must be of this form. */
  abstract void take(int world, Policy policy);

  /** Whether it looks at the velocities of the sight. */
  boolean needsVelocity() {
    return false;
  }

  /**
   * Decides in all worlds. {@code own} are the directions commanded last, {@code known} those of the
   * opponent; the decided ones go to {@code into}. Each begins at its offset. {@link #turned} is
   * what they differ by from the own.
   */
  abstract void decide(
      LaneSight sight,
      Directions own,
      int ownAt,
      Directions known,
      int knownAt,
      Directions into,
      int intoAt);

  void start(float headingRad) {
    Arrays.fill(heading, headingRad);
  }

  /** All worlds' decisions become commands. */
  final void commit() {
    System.arraycopy(newHeading, 0, heading, 0, WORLDS);
  }

  /** By how much the decided directions differ from the own ones. */
  final void measureTurns(Directions own, int ownAt, Directions into, int intoAt) {
    // Two directions a chord apart are at an angle of 2 arcsin(chord / 2) = π − 2 arccos(chord / 2).
    FloatVector quarter = FloatVector.broadcast(SPECIES, 0.25f),
        minusTwo = FloatVector.broadcast(SPECIES, -2f),
        one = FloatVector.broadcast(SPECIES, 1f),
        pi = FloatVector.broadcast(SPECIES, 3.14159265f),
        acos0 = FloatVector.broadcast(SPECIES, 1.5707963050f),
        acos1 = FloatVector.broadcast(SPECIES, -0.2145988016f),
        acos2 = FloatVector.broadcast(SPECIES, 0.0889789874f),
        acos3 = FloatVector.broadcast(SPECIES, -0.0501743046f),
        acos4 = FloatVector.broadcast(SPECIES, 0.0308918810f),
        acos5 = FloatVector.broadcast(SPECIES, -0.0170881256f),
        acos6 = FloatVector.broadcast(SPECIES, 0.0066700901f),
        acos7 = FloatVector.broadcast(SPECIES, -0.0012624911f);
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector x =
          FloatVector.fromArray(SPECIES, into.cos, intoAt + i)
              .sub(FloatVector.fromArray(SPECIES, own.cos, ownAt + i));
      FloatVector y =
          FloatVector.fromArray(SPECIES, into.sin, intoAt + i)
              .sub(FloatVector.fromArray(SPECIES, own.sin, ownAt + i));
      FloatVector half = x.fma(x, y.mul(y)).mul(quarter).sqrt().min(one);
      FloatVector series =
          half.fma(acos7, acos6)
              .fma(half, acos5)
              .fma(half, acos4)
              .fma(half, acos3)
              .fma(half, acos2)
              .fma(half, acos1)
              .fma(half, acos0);
      one.sub(half).sqrt().mul(series).fma(minusTwo, pi).intoArray(turned, i);
    }
  }

  /** Directions of {@link #newHeading}. */
  final void point(Directions into, int intoAt) {
    LaneMath.sinCos(newHeading, into.sin, into.cos, intoAt, WORLDS);
  }
}
