package skein.planning;

import static jdk.incubator.vector.VectorOperators.GT;
import static jdk.incubator.vector.VectorOperators.LSHR;
import static jdk.incubator.vector.VectorOperators.LT;
import static skein.rollout.LaneMath.INTS;
import static skein.rollout.LaneMath.LANES;
import static skein.rollout.LaneMath.ONE;
import static skein.rollout.LaneMath.SPECIES;
import static skein.rollout.LaneMath.ZERO;
import static skein.rollout.LaneMath.constant;

import java.util.Arrays;
import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.IntVector;
import jdk.incubator.vector.VectorMask;
import skein.rollout.LaneMath;
import skein.rollout.LaneRandom;
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
final class PlanKernel implements CandidateBlock {
  private static final FloatVector SIN_3 = constant(-1f / 6), SIN_5 = constant(1f / 120);
  private static final FloatVector SIN_7 = constant(-1f / 5040);
  private static final FloatVector COS_2 = constant(-0.5f), COS_4 = constant(1f / 24);
  private static final FloatVector COS_6 = constant(-1f / 720);

  // (1 − e^(−a)) / a = 1 − a/2 + a²/6 − …, whose next term is below 7e-6 for a up to 0.5.
  private static final FloatVector GLIDE_1 = constant(-1f / 2), GLIDE_2 = constant(1f / 6);
  private static final FloatVector GLIDE_3 = constant(-1f / 24), GLIDE_4 = constant(1f / 120);
  private static final FloatVector GLIDE_5 = constant(-1f / 720);

  private static final FloatVector ONE_AND_A_HALF = constant(1.5f), HALF = constant(0.5f);
  private static final FloatVector TINY = constant((float) ManoeuvreRollout.Tiny());
  private static final FloatVector BREACH = constant((float) ManoeuvreRollout.Breach());
  private static final FloatVector GUARD = constant((float) ManoeuvreRollout.Guard());
  private static final FloatVector FAR = constant(1e9f);
  private static final FloatVector LEAST_EXPONENT = constant(-80f), MOST_EXPONENT = constant(20f);

  // The sum of the four bytes of a hash: nearly normal, with mean 510 and this deviation.
  private static final FloatVector NORMAL_SCALE = constant(Draws.Scale());
  private static final IntVector BYTES = IntVector.broadcast(INTS, 0x00ff00ff);
  private static final IntVector LOWER = IntVector.broadcast(INTS, 0xffff);

  /** The bits of 2²³, whose lowest ones count up from there: an integer becomes a float by them. */
  private static final IntVector FLOAT_BITS = IntVector.broadcast(INTS, 0x4b000000);

  private static final FloatVector FLOAT_BASE = constant(8388608f + 510f);

  private static final int SIZE = CandidateBlock.Size();

  private final int steps;
  private final float[] turnRates, speeds;
  private final float[] costs = new float[SIZE];
  private final float[] weights = new float[SIZE];
  private final float[] turnSums, speedSums, weightSums = new float[SIZE];
  private final int[] bits = new int[SIZE];
  private final float[] turnNoise = new float[SIZE], speedNoise = new float[SIZE];

  // The way of each candidate: where it is at the end of each step, and where it headed before.
  private final float[] x, y, cos, sin;
  private final float[] endVx = new float[SIZE], endVy = new float[SIZE];
  private final float[] targetX, targetY;
  private final float[] targetEndVx = new float[SIZE], targetEndVy = new float[SIZE];

  private Situation situation;
  private Objective objective;
  private double originX, originY;
  private float dtS;

  /** The other vehicles' places at the end of each step, one vehicle after the other. */
  private float[] othersX, othersY;

  PlanKernel(int steps) {
    this.steps = steps;
    turnRates = new float[steps * SIZE];
    speeds = new float[steps * SIZE];
    turnSums = new float[steps * SIZE];
    speedSums = new float[steps * SIZE];
    x = new float[steps * SIZE];
    y = new float[steps * SIZE];
    cos = new float[steps * SIZE];
    sin = new float[steps * SIZE];
    targetX = new float[steps * SIZE];
    targetY = new float[steps * SIZE];
  }

  @Override
  public float[] turnRates() {
    return turnRates;
  }

  @Override
  public float[] speeds() {
    return speeds;
  }

  @Override
  public float[] costs() {
    return costs;
  }

  @Override
  public float[] turnSums() {
    return turnSums;
  }

  @Override
  public float[] speedSums() {
    return speedSums;
  }

  @Override
  public float[] weightSums() {
    return weightSums;
  }

  @Override
  public void situate(Situation situation, Objective objective, double dtS) {
    this.situation = situation;
    this.objective = objective;
    this.dtS = (float) dtS;
    originX = situation.own().x();
    originY = situation.own().y();
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

  @Override
  public void draw(int[] keys, Search search, int stepsPerKnot) {
    for (int step = 0, knot = 0; step < steps; step += stepsPerKnot, knot++) {
      noise(keys, 2 * knot, turnNoise);
      noise(keys, 2 * knot + 1, speedNoise);
      int end = Math.min(steps, step + stepsPerKnot);
      for (int each = step; each < end; each++) perturb(each, search);
    }
  }

  private void noise(int[] keys, int place, float[] into) {
    LaneRandom.upperBits(keys, place, 0, bits, SIZE);
    for (int i = 0; i < SIZE; i += LANES) {
      IntVector drawn = IntVector.fromArray(INTS, bits, i);
      IntVector pairs = drawn.and(BYTES).add(drawn.lanewise(LSHR, 8).and(BYTES));
      IntVector sum = pairs.and(LOWER).add(pairs.lanewise(LSHR, 16));
      sum.or(FLOAT_BITS)
          .reinterpretAsFloats()
          .sub(FLOAT_BASE)
          .mul(NORMAL_SCALE)
          .intoArray(into, i);
    }
  }

  private void perturb(int step, Search search) {
    Limits limits = objective.limits();
    FloatVector slowest = constant((float) limits.minSpeed());
    FloatVector fastest = constant((float) limits.maxSpeed());
    FloatVector steepest = constant((float) limits.maxTurnRate());
    FloatVector curvature = constant((float) limits.curvature());
    FloatVector turnMean = constant(search.turnMeans()[step]);
    FloatVector turnSd = constant(search.turnSds()[step]);
    FloatVector speedMean = constant(search.speedMeans()[step]);
    FloatVector speedSd = constant(search.speedSds()[step]);
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
    bound();
    if (situation.others().nonEmpty()) keepApart();
    for (int each = 0; each < situation.behaviours().size(); each++) {
      Behaviour behaviour = situation.behaviours().apply(each);
      if (behaviour.target() instanceof Target.Evader evader) evade(evader);
      else follow((Target.Along) behaviour.target());
      score((float) behaviour.weight());
    }
  }

  /**
   * Flies the vehicle itself: {@link ManoeuvreRollout} has the formulas. Its velocity decays by
   * e^(−a) in a step, a = (1 / lag + drag · speed) · dt.
   */
  private void steer() {
    Motion own = situation.own();
    ReducedModel model = situation.response();
    float lag = (float) model.lagS();
    FloatVector gain = constant((float) model.gain());
    FloatVector dt = constant(dtS), perLag = constant((float) (dtS / model.lagS()));
    FloatVector drag = constant((float) (model.dragPerM() * dtS));
    FloatVector brake = constant((float) (model.dragPerM() * model.lagS()));
    FloatVector startVx = constant((float) own.vx()), startVy = constant((float) own.vy());
    FloatVector startCos = constant((float) StrictMath.cos(situation.headingRad()));
    FloatVector startSin = constant((float) StrictMath.sin(situation.headingRad()));
    float firstTurnS = (float) situation.sinceDecisionS();
    for (int i = 0; i < SIZE; i += LANES) {
      FloatVector px = ZERO, py = ZERO, vx = startVx, vy = startVy, c = startCos, s = startSin;
      for (int step = 0, at = i; step < steps; step++, at += SIZE) {
        c.intoArray(cos, at);
        s.intoArray(sin, at);
        FloatVector angle =
            FloatVector.fromArray(SPECIES, turnRates, at).mul(step == 0 ? firstTurnS : dtS);
        FloatVector square = angle.mul(angle);
        FloatVector sinTurn =
            square.fma(SIN_7, SIN_5).fma(square, SIN_3).mul(square).fma(angle, angle);
        FloatVector cosTurn = square.fma(COS_6, COS_4).fma(square, COS_2).fma(square, ONE);
        FloatVector turned = c.mul(cosTurn).sub(s.mul(sinTurn));
        s = s.mul(cosTurn).add(c.mul(sinTurn));
        // One step of Newton's method keeps the length at 1.
        FloatVector length = turned.fma(turned, s.mul(s)).mul(HALF);
        FloatVector unit = ONE_AND_A_HALF.sub(length);
        c = turned.mul(unit);
        s = s.mul(unit);
        FloatVector pace = vx.fma(vx, vy.mul(vy)).sqrt();
        FloatVector a = pace.fma(drag, perLag);
        FloatVector slide = a.fma(GLIDE_5, GLIDE_4).fma(a, GLIDE_3).fma(a, GLIDE_2).fma(a, GLIDE_1);
        FloatVector glided = slide.fma(a, ONE);
        FloatVector decay = ONE.sub(glided.mul(a)), glide = glided.mul(dt);
        FloatVector speed =
            FloatVector.fromArray(SPECIES, speeds, at).mul(gain).div(pace.fma(brake, ONE));
        FloatVector wantedX = speed.mul(c), wantedY = speed.mul(s);
        FloatVector offX = vx.sub(wantedX), offY = vy.sub(wantedY);
        px = offX.fma(glide, wantedX.fma(dt, px));
        py = offY.fma(glide, wantedY.fma(dt, py));
        vx = offX.fma(decay, wantedX);
        vy = offY.fma(decay, wantedY);
        px.intoArray(x, at);
        py.intoArray(y, at);
      }
      // Where the momentum still carries it, if nothing more is commanded.
      vx.mul(lag).intoArray(endVx, i);
      vy.mul(lag).intoArray(endVy, i);
    }
  }

  /** What the manoeuvre costs by itself: effort, and leaving the geofence. */
  private void bound() {
    Geofence fence = objective.geofence();
    FloatVector south = constant(within(fence.minNorth() - originX));
    FloatVector north = constant(within(fence.maxNorth() - originX));
    FloatVector west = constant(within(fence.minEast() - originY));
    FloatVector east = constant(within(fence.maxEast() - originY));
    FloatVector turning = constant((float) objective.turning() * dtS);
    FloatVector hurry = constant((float) objective.speedChange() * dtS);
    FloatVector cruise = constant((float) objective.cruiseSpeed());
    for (int i = 0; i < SIZE; i += LANES) {
      FloatVector cost = ZERO;
      for (int step = 0, at = i; step < steps; step++, at += SIZE) {
        FloatVector turn = FloatVector.fromArray(SPECIES, turnRates, at);
        FloatVector speed = FloatVector.fromArray(SPECIES, speeds, at);
        FloatVector aside = turn.mul(speed), slow = speed.sub(cruise);
        cost = aside.mul(aside).fma(turning, slow.mul(slow).fma(hurry, cost));
        FloatVector px = FloatVector.fromArray(SPECIES, x, at);
        FloatVector py = FloatVector.fromArray(SPECIES, y, at);
        FloatVector beyond =
            south.sub(px).max(px.sub(north)).max(west.sub(py)).max(py.sub(east)).add(GUARD);
        VectorMask<Float> outside = beyond.compare(GT, ZERO);
        cost = cost.add(ZERO.blend(beyond.add(ONE).mul(BREACH), outside));
      }
      cost.intoArray(costs, i);
    }
  }

  private static float within(double bound) {
    return (float) Math.max(-1e6, Math.min(1e6, bound));
  }

  /** What it costs to come near the other vehicles. */
  private void keepApart() {
    Separation separation = objective.separation();
    FloatVector least = constant((float) (separation.minimum() + ManoeuvreRollout.Guard()));
    FloatVector price = constant((float) separation.price() * dtS);
    for (int i = 0; i < SIZE; i += LANES) {
      FloatVector cost = FloatVector.fromArray(SPECIES, costs, i);
      for (int step = 0, at = i; step < steps; step++, at += SIZE) {
        FloatVector px = FloatVector.fromArray(SPECIES, x, at);
        FloatVector py = FloatVector.fromArray(SPECIES, y, at);
        float clearance = (float) separation.clearance((step + 1) * dtS);
        for (int other = step; other < othersX.length; other += steps) {
          FloatVector dx = px.sub(othersX[other]), dy = py.sub(othersY[other]);
          FloatVector distance = dx.fma(dx, dy.fma(dy, TINY)).sqrt();
          FloatVector missing = distance.neg().add(clearance).max(ZERO);
          VectorMask<Float> breached = distance.compare(LT, least);
          cost =
              missing
                  .mul(missing)
                  .fma(price, cost)
                  .add(ZERO.blend(least.sub(distance).add(ONE).mul(BREACH), breached));
        }
      }
      cost.intoArray(costs, i);
    }
  }

  /** The paper's evader, which knows the heading commanded before this step's. */
  private void evade(Target.Evader evader) {
    ReducedModel model = evader.response();
    FloatVector dt = constant(dtS), perLag = constant((float) (dtS / model.lagS()));
    FloatVector drag = constant((float) (model.dragPerM() * dtS));
    FloatVector brake = constant((float) (model.dragPerM() * model.lagS()));
    FloatVector commanded = constant((float) (evader.speed() * model.gain()));
    FloatVector radius = constant((float) evader.turningRadius());
    FloatVector circle = radius.mul(radius), near = circle.mul(4f);
    FloatVector startX = constant((float) (evader.motion().x() - originX));
    FloatVector startY = constant((float) (evader.motion().y() - originY));
    FloatVector startVx = constant((float) evader.motion().vx());
    FloatVector startVy = constant((float) evader.motion().vy());
    float lag = (float) model.lagS();
    for (int i = 0; i < SIZE; i += LANES) {
      FloatVector tx = startX, ty = startY, vx = startVx, vy = startVy, px = ZERO, py = ZERO;
      for (int step = 0, at = i; step < steps; step++, at += SIZE) {
        FloatVector c = FloatVector.fromArray(SPECIES, cos, at);
        FloatVector s = FloatVector.fromArray(SPECIES, sin, at);
        FloatVector dx = tx.sub(px), dy = ty.sub(py);
        FloatVector ahead = dx.fma(c, dy.mul(s)), right = dy.mul(c).sub(dx.mul(s));
        FloatVector square = ahead.mul(ahead);
        FloatVector inner = right.sub(radius), outer = right.add(radius);
        VectorMask<Float> inRight = inner.fma(inner, square).compare(LT, circle);
        VectorMask<Float> inLeft = outer.fma(outer, square).compare(LT, circle);
        VectorMask<Float> isNear = right.fma(right, square).compare(LT, near);
        FloatVector u = ahead.blend(right.neg(), isNear).blend(ahead, inLeft).blend(ahead, inRight);
        FloatVector w = right.blend(ahead, isNear).blend(inner, inLeft).blend(outer, inRight);
        FloatVector pace = vx.fma(vx, vy.mul(vy)).sqrt();
        FloatVector a = pace.fma(drag, perLag);
        FloatVector slide = a.fma(GLIDE_5, GLIDE_4).fma(a, GLIDE_3).fma(a, GLIDE_2).fma(a, GLIDE_1);
        FloatVector glided = slide.fma(a, ONE);
        FloatVector decay = ONE.sub(glided.mul(a)), glide = glided.mul(dt);
        FloatVector length = u.fma(u, w.fma(w, TINY)).sqrt();
        FloatVector scale = commanded.div(length.mul(pace.fma(brake, ONE)));
        FloatVector wantedX = u.mul(c).sub(w.mul(s)).mul(scale);
        FloatVector wantedY = u.mul(s).add(w.mul(c)).mul(scale);
        FloatVector offX = vx.sub(wantedX), offY = vy.sub(wantedY);
        tx = offX.fma(glide, wantedX.fma(dt, tx));
        ty = offY.fma(glide, wantedY.fma(dt, ty));
        vx = offX.fma(decay, wantedX);
        vy = offY.fma(decay, wantedY);
        tx.intoArray(targetX, at);
        ty.intoArray(targetY, at);
        px = FloatVector.fromArray(SPECIES, x, at);
        py = FloatVector.fromArray(SPECIES, y, at);
      }
      vx.mul(lag).intoArray(targetEndVx, i);
      vy.mul(lag).intoArray(targetEndVy, i);
    }
  }

  private void follow(Target.Along along) {
    for (int step = 0, at = 0; step < steps; step++, at += SIZE) {
      Arrays.fill(targetX, at, at + SIZE, (float) (along.track().x(step) - originX));
      Arrays.fill(targetY, at, at + SIZE, (float) (along.track().y(step) - originY));
    }
    Arrays.fill(targetEndVx, (float) along.track().carriedX(situation.response().lagS(), dtS));
    Arrays.fill(targetEndVy, (float) along.track().carriedY(situation.response().lagS(), dtS));
  }

  /** What the distance to the target costs, times the weight of the behaviour. */
  private void score(float weight) {
    float each = (float) objective.distance() * dtS;
    FloatVector nearest = constant((float) objective.closest());
    FloatVector carried = constant((float) objective.carried());
    FloatVector radius = constant((float) objective.captureRadius());
    FloatVector bonus = constant((float) objective.capture());
    double softness = objective.softness();
    FloatVector soft = constant((float) (softness * softness + ManoeuvreRollout.Tiny()));
    for (int i = 0; i < SIZE; i += LANES) {
      FloatVector sum = ZERO, least = FAR, dx = ZERO, dy = ZERO;
      for (int step = 0, at = i; step < steps; step++, at += SIZE) {
        dx =
            FloatVector.fromArray(SPECIES, targetX, at)
                .sub(FloatVector.fromArray(SPECIES, x, at));
        dy =
            FloatVector.fromArray(SPECIES, targetY, at)
                .sub(FloatVector.fromArray(SPECIES, y, at));
        FloatVector distance = dx.fma(dx, dy.fma(dy, soft)).sqrt();
        sum = sum.add(distance);
        least = least.min(distance);
      }
      FloatVector endX =
          dx.add(FloatVector.fromArray(SPECIES, targetEndVx, i))
              .sub(FloatVector.fromArray(SPECIES, endVx, i));
      FloatVector endY =
          dy.add(FloatVector.fromArray(SPECIES, targetEndVy, i))
              .sub(FloatVector.fromArray(SPECIES, endVy, i));
      FloatVector end = endX.fma(endX, endY.fma(endY, soft)).sqrt();
      FloatVector captured = ZERO.blend(bonus, least.compare(LT, radius));
      FloatVector cost = sum.mul(each).add(least.mul(nearest)).add(end.mul(carried)).sub(captured);
      cost.mul(weight).add(FloatVector.fromArray(SPECIES, costs, i)).intoArray(costs, i);
    }
  }

  @Override
  public void forget() {
    Arrays.fill(turnSums, 0f);
    Arrays.fill(speedSums, 0f);
    Arrays.fill(weightSums, 0f);
  }

  @Override
  public void weigh(float base, float temperature) {
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
