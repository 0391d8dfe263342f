package skein.rollout;

import jdk.incubator.vector.FloatVector;

/**
 * One network of {@code skein.policy.NeuralPolicy} for many worlds at once, by lanes of floats; one
 * per thread. Turn rates differ from the scalar network's by less than 1e-6 of the largest without a
 * hidden layer, 1e-5 with one of 8 neurons and 1e-4 with up to three of 32, for weights up to 3:
 * each layer multiplies the errors of the one before by its weights. {@code NeuralPolicySuite} holds
 * it to that. A world's result does not depend on how many worlds there are.
 */
public final class NeuralKernel {
  private static final FloatVector ONE = LaneMath.ONE;
  private static final FloatVector TWO = LaneMath.constant(2f);

  /** tanh 9 is 1 in floats. */
  private static final FloatVector SATURATED = LaneMath.constant(9f);

  private static final FloatVector NEGATIVE_SATURATED = LaneMath.constant(-9f);

  private final int[] widths;
  private final int worlds;
  private final float[] weights;
  private final float[] sines;
  private final float[] cosines;

  // By neuron, then by world.
  private float[] inputs;
  private float[] outputs;

  /**
   * @param widths neurons of each layer: 4 inputs, hidden layers, 1 output
   * @param worlds a multiple of {@link LaneMath#LANES}
   */
  public NeuralKernel(int[] widths, int worlds) {
    if (widths.length < 2 || widths[0] != 4 || widths[widths.length - 1] != 1) {
      throw new IllegalArgumentException("expected layers from 4 inputs to 1 output");
    }
    if (worlds <= 0 || worlds % LaneMath.LANES != 0) {
      throw new IllegalArgumentException(
          "expected a multiple of " + LaneMath.LANES + " worlds, came " + worlds);
    }
    this.widths = widths.clone();
    this.worlds = worlds;
    int parameters = 0;
    int widest = 0;
    for (int layer = 0; layer < widths.length; layer++) {
      widest = Math.max(widest, widths[layer]);
      parameters += layer == 0 ? 0 : widths[layer] * (widths[layer - 1] + 1);
    }
    weights = new float[parameters];
    sines = new float[worlds];
    cosines = new float[worlds];
    inputs = new float[widest * worlds];
    outputs = new float[widest * worlds];
  }

  /** Takes the weights and biases that the worlds fly by from now on, as NeuralShape lays them out. */
  public void load(double[] parameters) {
    if (parameters.length != weights.length) {
      throw new IllegalArgumentException(
          "expected " + weights.length + " parameters, came " + parameters.length);
    }
    for (int i = 0; i < weights.length; i++) {
      weights[i] = (float) parameters[i];
    }
  }

  /**
   * Turn rates to the right, as shares of the largest, in −1 to 1; arrays are by world.
   *
   * @param dx the opponent's position minus the own one, m, and so on as in Policy; headings up to
   *     ±8192 rad
   */
  public void turnShares(
      float[] dx, float[] dy, float[] dvx, float[] dvy, float[] headings, float[] turns) {
    LaneMath.sinCos(headings, sines, cosines, worlds);
    intoOwnFrame(dx, dy, 0, (float) (1 / skein.policy.NeuralPolicy.LengthM()));
    intoOwnFrame(dvx, dvy, 2, (float) (1 / skein.policy.NeuralPolicy.SpeedMps()));
    int at = 0;
    for (int layer = 1; layer < widths.length; layer++) {
      sum(at, widths[layer - 1], widths[layer]);
      LaneMath.exp(outputs, 0, widths[layer] * worlds);
      squash(widths[layer] * worlds);
      at += widths[layer] * (widths[layer - 1] + 1);
      float[] spare = inputs;
      inputs = outputs;
      outputs = spare;
    }
    System.arraycopy(inputs, 0, turns, 0, worlds);
  }

  private void intoOwnFrame(float[] xs, float[] ys, int first, float scale) {
    int right = (first + 1) * worlds;
    for (int i = 0; i < worlds; i += LaneMath.LANES) {
      FloatVector x = FloatVector.fromArray(LaneMath.SPECIES, xs, i);
      FloatVector y = FloatVector.fromArray(LaneMath.SPECIES, ys, i);
      FloatVector sin = FloatVector.fromArray(LaneMath.SPECIES, sines, i);
      FloatVector cos = FloatVector.fromArray(LaneMath.SPECIES, cosines, i);
      x.mul(cos).add(y.mul(sin)).mul(scale).intoArray(inputs, first * worlds + i);
      y.mul(cos).sub(x.mul(sin)).mul(scale).intoArray(inputs, right + i);
    }
  }

  /** Twice each neuron's sum of weighted inputs and bias, within ±18: the exponents of tanh. */
  private void sum(int first, int fanIn, int neurons) {
    for (int neuron = 0; neuron < neurons; neuron++) {
      int row = first + neuron * (fanIn + 1);
      for (int i = 0; i < worlds; i += LaneMath.LANES) {
        FloatVector sum = FloatVector.broadcast(LaneMath.SPECIES, weights[row + fanIn]);
        for (int input = 0; input < fanIn; input++) {
          sum =
              FloatVector.fromArray(LaneMath.SPECIES, inputs, input * worlds + i)
                  .fma(FloatVector.broadcast(LaneMath.SPECIES, weights[row + input]), sum);
        }
        sum.min(SATURATED).max(NEGATIVE_SATURATED).mul(TWO).intoArray(outputs, neuron * worlds + i);
      }
    }
  }

  /** tanh x = (e²ˣ − 1) / (e²ˣ + 1), in place. */
  private void squash(int count) {
    for (int i = 0; i < count; i += LaneMath.LANES) {
      FloatVector power = FloatVector.fromArray(LaneMath.SPECIES, outputs, i);
      power.sub(ONE).div(power.add(ONE)).intoArray(outputs, i);
    }
  }
}
