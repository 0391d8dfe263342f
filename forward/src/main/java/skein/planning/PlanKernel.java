package skein.planning;

import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LSHR;
import static jdk.incubator.vector.VectorOperators.LT;
import static skein.simd.LaneMath.INTS;
import static skein.simd.LaneMath.LANES;
import static skein.simd.LaneMath.SPECIES;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import skein.scenario.Fence;
import skein.simd.LaneMath;
import skein.simd.LaneRandom;
import skein.vehicle.ReducedModel;

/**
 * Flies many candidate manoeuvres of one vehicle at once and says what each costs; {@link
 * ManoeuvreRollout} is its scalar reference, {@code PlanKernelSuite} holds the two together. The
 * vehicle's own way does not depend on what its opponent does, so it is flown once and every
 * behaviour of the opponent is flown against it.
 *
 * <p>Positions are counted from where the vehicle starts, so that floats resolve them. Results do
 * not depend on the lane count. Nothing is allocated after {@link #situate}; one instance per
 * thread.
 */
final class PlanKernel extends CandidateBlock {
  private static final float SIN_3 = -1f / 6, SIN_5 = 1f / 120, SIN_7 = -1f / 5040;
  private static final float COS_2 = -0.5f, COS_4 = 1f / 24, COS_6 = -1f / 720;

  private static final float TINY = (float) ManoeuvreRollout.Tiny();
  private static final float BREACH = (float) ManoeuvreRollout.Breach();
  private static final float GUARD = (float) ManoeuvreRollout.Guard();
  private static final float FAR = 1e9f;
  private static final float LEAST_EXPONENT = -80f, MOST_EXPONENT = 20f;

  // The sum of the four bytes of a hash: nearly normal, with mean 510 and this deviation.
  private static final float NORMAL_SCALE = Draws.Scale();
  private static final int BYTES = 0x00ff00ff;
  private static final int LOWER = 0xffff;

  /** The bits of 2²³, whose lowest ones count up from there: an integer becomes a float by them. */
  private static final int FLOAT_BITS = 0x4b000000;

  private static final float FLOAT_BASE = 8388608f + 510f;

  private static final int SIZE = CandidateBlock.Size();

  private final int steps;
  private final float[] weights = new float[SIZE];
  private final int[] bits = new int[SIZE];
  private final float[] turnNoise = new float[SIZE], speedNoise = new float[SIZE];

  /** Of the candidates, counted from where they start, and of a target. */
  private final BlockWay own, target;

  /** Where each candidate headed before each step. */
  private final float[] cos, sin;

  private Situation situation;
  private PlanCost objective;
  private double originX, originY;
  private float dtS;

  /** By behaviour; absent where the target's way depends on nobody. */
  private OpponentLanes[] opponents = {};

  /** The other vehicles' places at the end of each step, one vehicle after the other. */
  private float[] othersX, othersY;

  PlanKernel(int steps) {
    super(steps);
    this.steps = steps;
    own = new BlockWay(steps);
    target = new BlockWay(steps);
    cos = new float[steps * SIZE];
    sin = new float[steps * SIZE];
  }

  @Override
  public void situate(Situation situation, PlanCost objective, double dtS) {
    this.situation = situation;
    this.objective = objective;
    this.dtS = (float) dtS;
    originX = situation.own().x();
    originY = situation.own().y();
    own.start(situation.own(), situation.own());
    takeOpponents();
    int others = situation.others().size();
    othersX = new float[others * steps];
    othersY = new float[others * steps];
    for (int other = 0; other < others; other++) {
      PredictedTrack track = situation.others().apply(other);
      for (int step = 0; step < steps; step++) {
        othersX[other * steps + step] = (float) (track.x(step) - originX);
        othersY[other * steps + step] = (float) (track.y(step) - originY);
      }
    }
  }

  private void takeOpponents() {
    int count = situation.behaviours().size();
    if (opponents.length < count) opponents = Arrays.copyOf(opponents, count);
    for (int each = 0; each < count; each++)
      if (situation.behaviours().apply(each).target() instanceof Target.Opponent opponent) {
        if (opponents[each] == null) opponents[each] = new OpponentLanes();
        opponents[each].take(opponent);
      }
  }

  @Override
  public void draw(int[] keys, SamplingDistribution search, int stepsPerKnot) {
    for (int step = 0, knot = 0; step < steps; step += stepsPerKnot, knot++) {
      noise(keys, 2 * knot, turnNoise);
      noise(keys, 2 * knot + 1, speedNoise);
      int end = Math.min(steps, step + stepsPerKnot);
      for (int each = step; each < end; each++) perturb(each, search);
    }
  }

  private void noise(int[] keys, int place, float[] into) {
    LaneRandom.upperBits(keys, place, 0, bits, SIZE);
    IntVector bytes = IntVector.broadcast(INTS, BYTES),
        lower = IntVector.broadcast(INTS, LOWER),
        floatBits = IntVector.broadcast(INTS, FLOAT_BITS);
    FloatVector base = FloatVector.broadcast(SPECIES, FLOAT_BASE),
        scale = FloatVector.broadcast(SPECIES, NORMAL_SCALE);
    for (int i = 0; i < SIZE; i += LANES) {
      IntVector drawn = IntVector.fromArray(INTS, bits, i);
      IntVector pairs = drawn.and(bytes).add(drawn.lanewise(LSHR, 8).and(bytes));
      IntVector sum = pairs.and(lower).add(pairs.lanewise(LSHR, 16));
      sum.or(floatBits)
          .reinterpretAsFloats()
          .sub(base)
          .mul(scale)
          .intoArray(into, i);
    }
  }

  private void perturb(int step, SamplingDistribution search) {
    float[] turnRates = turnRates(), speeds = speeds();
    Limits limits = objective.limits();
    FloatVector slowest = FloatVector.broadcast(SPECIES, (float) limits.minSpeed());
    FloatVector fastest = FloatVector.broadcast(SPECIES, (float) limits.maxSpeed());
    FloatVector steepest = FloatVector.broadcast(SPECIES, (float) limits.maxTurnRate());
    FloatVector curvature = FloatVector.broadcast(SPECIES, (float) limits.curvature());
    FloatVector turnMean = FloatVector.broadcast(SPECIES, search.turnMeans()[step]);
    FloatVector turnSd = FloatVector.broadcast(SPECIES, search.turnSds()[step]);
    FloatVector speedMean = FloatVector.broadcast(SPECIES, search.speedMeans()[step]);
    FloatVector speedSd = FloatVector.broadcast(SPECIES, search.speedSds()[step]);
    for (int i = 0, at = step * SIZE; i < SIZE; i += LANES, at += LANES) {
      FloatVector speed =
          FloatVector.fromArray(SPECIES, speedNoise, i)
              .fma(speedSd, speedMean)
              .max(slowest)
              .min(fastest);
      FloatVector limit = speed.mul(curvature).min(steepest);
      FloatVector turn = FloatVector.fromArray(SPECIES, turnNoise, i).fma(turnSd, turnMean);
      turn.max(limit.neg()).min(limit).intoArray(turnRates, at);
      speed.intoArray(speeds, at);
    }
  }

  @Override
  public void fly() {
    steer();
    exert();
    for (int fence = 0; fence < objective.geofences().size(); fence++)
      stayInside(objective.geofences().apply(fence));
    if (situation.others().nonEmpty()) keepApart();
    for (int each = 0; each < situation.behaviours().size(); each++) {
      Behaviour behaviour = situation.behaviours().apply(each);
      double lagS = situation.response().lagS();
      if (behaviour.target() instanceof Target.Opponent opponent) {
        opponents[each].fly(own, cos, sin, situation.own(), dtS, target);
        lagS = opponent.response().lagS();
      } else follow(((Target.Along) behaviour.target()).track());
      score((float) behaviour.weight(), (float) lagS);
    }
  }

  /**
   * Flies the vehicle itself: {@link ManoeuvreRollout} has the formulas. Its velocity decays by
   * e^(−a) in a step, a = (1 / lag + drag · speed) · dt.
   */
  private void steer() {
    Motion start = situation.own();
    ReducedModel model = situation.response();
    FloatVector gain = FloatVector.broadcast(SPECIES, (float) model.gain());
    FloatVector dt = FloatVector.broadcast(SPECIES, dtS);
    FloatVector perLag = FloatVector.broadcast(SPECIES, (float) (dtS / model.lagS()));
    FloatVector drag = FloatVector.broadcast(SPECIES, (float) (model.dragPerM() * dtS));
    FloatVector brake = FloatVector.broadcast(SPECIES, (float) (model.dragPerM() * model.lagS()));
    FloatVector startVx = FloatVector.broadcast(SPECIES, (float) start.vx());
    FloatVector startVy = FloatVector.broadcast(SPECIES, (float) start.vy());
    FloatVector startCos =
        FloatVector.broadcast(SPECIES, (float) StrictMath.cos(situation.headingRad()));
    FloatVector startSin =
        FloatVector.broadcast(SPECIES, (float) StrictMath.sin(situation.headingRad()));
    float firstTurnS = (float) situation.sinceDecisionS();
    FloatVector sin3 = FloatVector.broadcast(SPECIES, SIN_3),
        sin5 = FloatVector.broadcast(SPECIES, SIN_5),
        sin7 = FloatVector.broadcast(SPECIES, SIN_7),
        cos2 = FloatVector.broadcast(SPECIES, COS_2),
        cos4 = FloatVector.broadcast(SPECIES, COS_4),
        cos6 = FloatVector.broadcast(SPECIES, COS_6),
        half = FloatVector.broadcast(SPECIES, 0.5f),
        oneAndAHalf = FloatVector.broadcast(SPECIES, 1.5f);
    FloatVector glide1 = FloatVector.broadcast(SPECIES, Glide.GLIDE_1),
        glide2 = FloatVector.broadcast(SPECIES, Glide.GLIDE_2),
        glide3 = FloatVector.broadcast(SPECIES, Glide.GLIDE_3),
        glide4 = FloatVector.broadcast(SPECIES, Glide.GLIDE_4),
        glide5 = FloatVector.broadcast(SPECIES, Glide.GLIDE_5),
        zero = FloatVector.broadcast(SPECIES, 0f),
        one = FloatVector.broadcast(SPECIES, 1f);
    float[] turnRates = turnRates(), speeds = speeds();
    float[] x = own.x, y = own.y, north = own.vx, east = own.vy;
    for (int i = 0; i < SIZE; i += LANES) {
      FloatVector px = zero, py = zero, vx = startVx, vy = startVy, c = startCos, s = startSin;
      for (int step = 0, at = i; step < steps; step++, at += SIZE) {
        c.intoArray(cos, at);
        s.intoArray(sin, at);
        FloatVector angle =
            FloatVector.fromArray(SPECIES, turnRates, at).mul(step == 0 ? firstTurnS : dtS);
        FloatVector square = angle.mul(angle);
        FloatVector sinTurn =
            square.fma(sin7, sin5).fma(square, sin3).mul(square).fma(angle, angle);
        FloatVector cosTurn = square.fma(cos6, cos4).fma(square, cos2).fma(square, one);
        FloatVector turned = c.mul(cosTurn).sub(s.mul(sinTurn));
        s = s.mul(cosTurn).add(c.mul(sinTurn));
        // One step of Newton's method keeps the length at 1.
        FloatVector length = turned.fma(turned, s.mul(s)).mul(half);
        FloatVector unit = oneAndAHalf.sub(length);
        c = turned.mul(unit);
        s = s.mul(unit);
        FloatVector pace = vx.fma(vx, vy.mul(vy)).sqrt();
        FloatVector a = pace.fma(drag, perLag);
        FloatVector slide = a.fma(glide5, glide4).fma(a, glide3).fma(a, glide2).fma(a, glide1);
        FloatVector glided = slide.fma(a, one);
        FloatVector decay = one.sub(glided.mul(a)), glide = glided.mul(dt);
        FloatVector speed =
            FloatVector.fromArray(SPECIES, speeds, at).mul(gain).div(pace.fma(brake, one));
        FloatVector wantedX = speed.mul(c), wantedY = speed.mul(s);
        FloatVector offX = vx.sub(wantedX), offY = vy.sub(wantedY);
        px = offX.fma(glide, wantedX.fma(dt, px));
        py = offY.fma(glide, wantedY.fma(dt, py));
        vx = offX.fma(decay, wantedX);
        vy = offY.fma(decay, wantedY);
        px.intoArray(x, at + SIZE);
        py.intoArray(y, at + SIZE);
        vx.intoArray(north, at + SIZE);
        vy.intoArray(east, at + SIZE);
      }
    }
  }

  /** What the manoeuvre costs by itself: its effort. */
  private void exert() {
    float[] turnRates = turnRates(), speeds = speeds(), costs = costs();
    FloatVector turning = FloatVector.broadcast(SPECIES, (float) objective.turning() * dtS);
    FloatVector hurry = FloatVector.broadcast(SPECIES, (float) objective.speedChange() * dtS);
    FloatVector cruise = FloatVector.broadcast(SPECIES, (float) objective.cruiseSpeed());
    FloatVector zero = FloatVector.broadcast(SPECIES, 0f);
    for (int i = 0; i < SIZE; i += LANES) {
      FloatVector cost = zero;
      for (int step = 0, at = i; step < steps; step++, at += SIZE) {
        FloatVector turn = FloatVector.fromArray(SPECIES, turnRates, at);
        FloatVector speed = FloatVector.fromArray(SPECIES, speeds, at);
        FloatVector aside = turn.mul(speed), slow = speed.sub(cruise);
        cost = aside.mul(aside).fma(turning, slow.mul(slow).fma(hurry, cost));
      }
      cost.intoArray(costs, i);
    }
  }

  /** What it costs to leave a geofence. */
  private void stayInside(Geofence geofence) {
    float[] costs = costs();
    float guard = GUARD + (float) geofence.marginM();
    FloatVector zero = FloatVector.broadcast(SPECIES, 0f),
        one = FloatVector.broadcast(SPECIES, 1f),
        breach = FloatVector.broadcast(SPECIES, BREACH);
    for (int i = 0; i < SIZE; i += LANES) {
      FloatVector cost = FloatVector.fromArray(SPECIES, costs, i);
      for (int step = 0, at = i; step < steps; step++, at += SIZE) {
        FloatVector px = FloatVector.fromArray(SPECIES, own.x, at + SIZE);
        FloatVector py = FloatVector.fromArray(SPECIES, own.y, at + SIZE);
        FloatVector beyond =
            (geofence.fence() instanceof Fence.Circle circle
                    ? beyond(circle, px, py)
                    : beyond((Fence.Polygon) geofence.fence(), px, py))
                .add(guard);
        VectorMask<Float> outside = beyond.compare(GT, zero);
        cost = cost.add(zero.blend(beyond.add(one).mul(breach), outside));
      }
      cost.intoArray(costs, i);
    }
  }

  private FloatVector beyond(Fence.Circle circle, FloatVector px, FloatVector py) {
    FloatVector dx = px.sub(within(circle.northM() - originX));
    FloatVector dy = py.sub(within(circle.eastM() - originY));
    return dx.fma(dx, dy.mul(dy)).sqrt().sub((float) circle.radiusM());
  }

  /** See {@link Fence#beyondM}. */
  private FloatVector beyond(Fence.Polygon polygon, FloatVector px, FloatVector py) {
    FloatVector zero = FloatVector.broadcast(SPECIES, 0f), nearest = zero.add(FAR);
    VectorMask<Float> inside = SPECIES.maskAll(false);
    int corners = polygon.corners().size();
    for (int from = 0; from < corners; from++) {
      int to = (from + 1) % corners;
      float n1 = north(polygon, from), e1 = east(polygon, from);
      float alongN = north(polygon, to) - n1, alongE = east(polygon, to) - e1;
      float length = alongN * alongN + alongE * alongE;
      FloatVector dn = px.sub(n1), de = py.sub(e1);
      FloatVector share =
          dn.mul(alongN).add(de.mul(alongE)).mul(length == 0 ? 0f : 1 / length).max(0f).min(1f);
      FloatVector offN = dn.sub(share.mul(alongN)), offE = de.sub(share.mul(alongE));
      nearest = nearest.min(offN.fma(offN, offE.mul(offE)).sqrt());
      if (alongE != 0) {
        VectorMask<Float> crosses = py.compare(LT, e1).xor(py.compare(LT, east(polygon, to)));
        VectorMask<Float> below = dn.compare(LT, de.mul(alongN / alongE));
        inside = inside.xor(crosses.and(below));
      }
    }
    return nearest.blend(nearest.neg(), inside);
  }

  private float north(Fence.Polygon polygon, int corner) {
    return within((double) polygon.corners().apply(corner)._1() - originX);
  }

  private float east(Fence.Polygon polygon, int corner) {
    return within((double) polygon.corners().apply(corner)._2() - originY);
  }

  private static float within(double bound) {
    return (float) Math.max(-1e6, Math.min(1e6, bound));
  }

  /** What it costs to come near the other vehicles. */
  private void keepApart() {
    float[] costs = costs();
    SeparationCost separation = objective.separation();
    FloatVector least =
        FloatVector.broadcast(SPECIES, (float) (separation.minimum() + ManoeuvreRollout.Guard()));
    FloatVector price = FloatVector.broadcast(SPECIES, (float) separation.price() * dtS);
    FloatVector zero = FloatVector.broadcast(SPECIES, 0f),
        one = FloatVector.broadcast(SPECIES, 1f),
        tiny = FloatVector.broadcast(SPECIES, TINY),
        breach = FloatVector.broadcast(SPECIES, BREACH);
    for (int i = 0; i < SIZE; i += LANES) {
      FloatVector cost = FloatVector.fromArray(SPECIES, costs, i);
      for (int step = 0, at = i; step < steps; step++, at += SIZE) {
        FloatVector px = FloatVector.fromArray(SPECIES, own.x, at + SIZE);
        FloatVector py = FloatVector.fromArray(SPECIES, own.y, at + SIZE);
        float clearance = (float) separation.clearance((step + 1) * dtS);
        for (int other = step; other < othersX.length; other += steps) {
          FloatVector dx = px.sub(othersX[other]), dy = py.sub(othersY[other]);
          FloatVector distance = dx.fma(dx, dy.fma(dy, tiny)).sqrt();
          FloatVector missing = distance.neg().add(clearance).max(zero);
          VectorMask<Float> breached = distance.compare(LT, least);
          cost =
              missing
                  .mul(missing)
                  .fma(price, cost)
                  .add(zero.blend(least.sub(distance).add(one).mul(breach), breached));
        }
      }
      cost.intoArray(costs, i);
    }
  }

  private void follow(PredictedTrack track) {
    for (int step = 0; step < steps; step++)
      target.fill(step + 1, track.x(step) - originX, track.y(step) - originY, 0, 0);
    Arrays.fill(target.vx, steps * SIZE, (steps + 1) * SIZE, (float) track.lastVx(dtS));
    Arrays.fill(target.vy, steps * SIZE, (steps + 1) * SIZE, (float) track.lastVy(dtS));
  }

  /**
   * What the distance to the target costs, times the weight of the behaviour.
   *
   * @param lagS for so long its last velocity carries the target on, if nothing more is commanded
   */
  private void score(float weight, float lagS) {
    FloatVector ownLag = FloatVector.broadcast(SPECIES, (float) situation.response().lagS()),
        lag = FloatVector.broadcast(SPECIES, lagS);
    float each = (float) objective.distance() * dtS;
    FloatVector nearest = FloatVector.broadcast(SPECIES, (float) objective.closest());
    FloatVector carried = FloatVector.broadcast(SPECIES, (float) objective.carried());
    FloatVector radius = FloatVector.broadcast(SPECIES, (float) objective.captureRadius());
    FloatVector bonus = FloatVector.broadcast(SPECIES, (float) objective.capture());
    double softness = objective.softness();
    FloatVector soft =
        FloatVector.broadcast(SPECIES, (float) (softness * softness + ManoeuvreRollout.Tiny()));
    FloatVector zero = FloatVector.broadcast(SPECIES, 0f),
        far = FloatVector.broadcast(SPECIES, FAR);
    float[] costs = costs(), x = own.x, y = own.y, theirX = target.x, theirY = target.y;
    int last = steps * SIZE;
    for (int i = 0; i < SIZE; i += LANES) {
      FloatVector sum = zero, least = far, dx = zero, dy = zero;
      for (int step = 0, at = i + SIZE; step < steps; step++, at += SIZE) {
        dx =
            FloatVector.fromArray(SPECIES, theirX, at).sub(FloatVector.fromArray(SPECIES, x, at));
        dy =
            FloatVector.fromArray(SPECIES, theirY, at).sub(FloatVector.fromArray(SPECIES, y, at));
        FloatVector distance = dx.fma(dx, dy.fma(dy, soft)).sqrt();
        sum = sum.add(distance);
        least = least.min(distance);
      }
      FloatVector endX =
          FloatVector.fromArray(SPECIES, target.vx, last + i)
              .fma(lag, dx)
              .sub(FloatVector.fromArray(SPECIES, own.vx, last + i).mul(ownLag));
      FloatVector endY =
          FloatVector.fromArray(SPECIES, target.vy, last + i)
              .fma(lag, dy)
              .sub(FloatVector.fromArray(SPECIES, own.vy, last + i).mul(ownLag));
      FloatVector end = endX.fma(endX, endY.fma(endY, soft)).sqrt();
      FloatVector captured = zero.blend(bonus, least.compare(LT, radius));
      FloatVector cost = sum.mul(each).add(least.mul(nearest)).add(end.mul(carried)).sub(captured);
      cost.mul(weight).add(FloatVector.fromArray(SPECIES, costs, i)).intoArray(costs, i);
    }
  }

  @Override
  public void weigh(float base, float temperature) {
    float[] turnRates = turnRates(), speeds = speeds(), costs = costs();
    float[] turnSums = turnSums(), speedSums = speedSums(), weightSums = weightSums();
    float coldness = -1 / temperature;
    for (int i = 0; i < SIZE; i += LANES)
      FloatVector.fromArray(SPECIES, costs, i)
          .sub(base)
          .mul(coldness)
          .max(LEAST_EXPONENT)
          .min(MOST_EXPONENT)
          .intoArray(weights, i);
    LaneMath.exp(weights, 0, SIZE);
    for (int i = 0; i < SIZE; i += LANES) {
      FloatVector weight = FloatVector.fromArray(SPECIES, weights, i);
      FloatVector.fromArray(SPECIES, weightSums, i).add(weight).intoArray(weightSums, i);
      for (int step = 0, at = i; step < steps; step++, at += SIZE) {
        FloatVector.fromArray(SPECIES, turnRates, at)
            .fma(weight, FloatVector.fromArray(SPECIES, turnSums, at))
            .intoArray(turnSums, at);
        FloatVector.fromArray(SPECIES, speeds, at)
            .fma(weight, FloatVector.fromArray(SPECIES, speedSums, at))
            .intoArray(speedSums, at);
      }
    }
  }
}
