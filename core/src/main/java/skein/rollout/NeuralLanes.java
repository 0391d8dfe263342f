package skein.rollout;

import static skein.rollout.LaneMath.LANES;
import static skein.rollout.LaneMath.SPECIES;
import static skein.rollout.LaneMath.constant;

import jdk.incubator.vector.FloatVector;
import skein.policy.NeuralPolicy;
import skein.policy.NeuralShape;
import skein.policy.Policy;

/**
 * {@link NeuralPolicy} by lanes: networks of one shape, each world with weights of its own. {@link
 * NeuralKernel} is the same with one network for all worlds.
 */
final class NeuralLanes extends LanePolicy {
  private static final FloatVector ONE = LaneMath.ONE;

  /** tanh 9 is 1 in floats. */
  private static final FloatVector SATURATED = constant(9f), MINUS_SATURATED = constant(-9f);

  private static final FloatVector TWO = constant(2f);
  private static final FloatVector PER_LENGTH = constant((float) (1 / NeuralPolicy.LengthM())),
      PER_SPEED = constant((float) (1 / NeuralPolicy.SpeedMps()));

  private final int[] widths;
  private final float[] turnRate = new float[WORLDS];

  /** By parameter, then by world. */
  private final float[] weights;

  // By neuron, then by world.
  private float[] inputs, outputs;

  NeuralLanes(NeuralShape shape) {
    widths = new int[shape.widths().size()];
    for (int i = 0; i < widths.length; i++) widths[i] = (Integer) shape.widths().apply(i);
    weights = new float[shape.parameters() * WORLDS];
    inputs = new float[shape.widest() * WORLDS];
    outputs = new float[shape.widest() * WORLDS];
  }

  @Override
  void take(int world, Policy policy) {
    NeuralPolicy network = (NeuralPolicy) policy;
    turnRate[world] = (float) network.turnRateRadPerS();
    for (int i = 0; i < network.parameters().size(); i++)
      weights[i * WORLDS + world] = ((Double) network.parameters().apply(i)).floatValue();
  }

  @Override
  boolean needsVelocity() {
    return true;
  }

  @Override
  void decide(
      LaneSight sight,
      Directions own,
      int ownAt,
      Directions known,
      int knownAt,
      Directions into,
      int intoAt) {
    intoOwnFrame(sight.dx, sight.dy, PER_LENGTH, own, ownAt, 0);
    intoOwnFrame(sight.dvx, sight.dvy, PER_SPEED, own, ownAt, 2);
    int at = 0;
    for (int layer = 1; layer < widths.length; layer++) {
      for (int neuron = 0; neuron < widths[layer]; neuron++) {
        sum(at, widths[layer - 1], neuron * WORLDS);
        at += widths[layer - 1] + 1;
      }
      LaneMath.exp(outputs, 0, widths[layer] * WORLDS);
      squash(widths[layer] * WORLDS);
      float[] spare = inputs;
      inputs = outputs;
      outputs = spare;
    }
    turn(sight);
    point(into, intoAt);
  }

  private void intoOwnFrame(
      float[] xs, float[] ys, FloatVector scale, Directions own, int ownAt, int first) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector x = FloatVector.fromArray(SPECIES, xs, i),
          y = FloatVector.fromArray(SPECIES, ys, i);
      FloatVector c = FloatVector.fromArray(SPECIES, own.cos, ownAt + i),
          s = FloatVector.fromArray(SPECIES, own.sin, ownAt + i);
      x.fma(c, y.mul(s)).mul(scale).intoArray(inputs, first * WORLDS + i);
      y.fma(c, x.mul(s).neg()).mul(scale).intoArray(inputs, (first + 1) * WORLDS + i);
    }
  }

  /** Twice a neuron's sum of weighted inputs and bias, within ±18: the exponent of tanh. */
  private void sum(int row, int fanIn, int into) {
    System.arraycopy(weights, (row + fanIn) * WORLDS, outputs, into, WORLDS);
    for (int input = 0; input < fanIn; input++) {
      int weight = (row + input) * WORLDS, from = input * WORLDS;
      for (int i = 0; i < WORLDS; i += LANES)
        FloatVector.fromArray(SPECIES, inputs, from + i)
            .fma(
                FloatVector.fromArray(SPECIES, weights, weight + i),
                FloatVector.fromArray(SPECIES, outputs, into + i))
            .intoArray(outputs, into + i);
    }
    for (int i = 0; i < WORLDS; i += LANES)
      FloatVector.fromArray(SPECIES, outputs, into + i)
          .min(SATURATED)
          .max(MINUS_SATURATED)
          .mul(TWO)
          .intoArray(outputs, into + i);
  }

  /** tanh x = (e²ˣ − 1) / (e²ˣ + 1), in place. */
  private void squash(int count) {
    for (int i = 0; i < count; i += LANES) {
      FloatVector power = FloatVector.fromArray(SPECIES, outputs, i);
      power.sub(ONE).div(power.add(ONE)).intoArray(outputs, i);
    }
  }

  private void turn(LaneSight sight) {
    for (int i = 0; i < WORLDS; i += LANES) {
      FloatVector change =
          FloatVector.fromArray(SPECIES, inputs, i)
              .mul(FloatVector.fromArray(SPECIES, turnRate, i))
              .mul(FloatVector.fromArray(SPECIES, sight.elapsed, i));
      change.add(FloatVector.fromArray(SPECIES, heading, i)).intoArray(newHeading, i);
      change
          .fma(PER_TURN, ROUND)
          .sub(ROUND)
          .fma(MINUS_TURN, change)
          .abs()
          .intoArray(turned, i);
    }
  }
}
