package skein.vtime.agent;

import java.util.Random;
import java.util.function.Supplier;

/**
 * Draws from the calling thread's environment; without one, or once a seed was set, draws like any
 * {@code Random}. For generators that outlive runs.
 */
final class GovernedRandom extends Random {
  private static final long serialVersionUID = 1;

  // Set by the constructor, since that of the superclass sets a seed, too.
  private boolean isMade;
  private boolean isSeeded;

  private final transient Supplier<Environment> environment;

  GovernedRandom(Supplier<Environment> environment) {
    this.environment = environment;
    isMade = true;
  }

  private Environment environment() {
    return isSeeded ? null : environment.get();
  }

  @Override
  public void setSeed(long seed) {
    super.setSeed(seed);
    if (isMade) isSeeded = true;
  }

  @Override
  protected int next(int bits) {
    var environment = environment();
    return environment == null ? super.next(bits) : environment.random().nextInt() >>> (32 - bits);
  }

  /** Overridden because the superclass keeps every second value for the next caller. */
  @Override
  public double nextGaussian() {
    var environment = environment();
    return environment == null ? super.nextGaussian() : environment.random().nextGaussian();
  }
}
