package skein.vtime.listed;

import java.util.function.LongSupplier;

/** A method reference to the clock, which in Scala would be compiled to a lambda with a call. */
final class References {
  private References() {}

  static final LongSupplier NANO_TIME = System::nanoTime;
}
