package skein.vtime.listed;

import java.util.Date;
import java.util.Random;
import java.util.SplittableRandom;
import java.util.function.LongSupplier;
import java.util.function.Supplier;

/** References to methods and constructors, which Scala would compile to lambdas with calls. */
final class References {
  private References() {}

  static final LongSupplier NANO_TIME = System::nanoTime;
  static final Supplier<Date> DATE = Date::new;
  static final Supplier<Random> RANDOM = Random::new;
  static final Supplier<SplittableRandom> SPLITTABLE = SplittableRandom::new;
}
