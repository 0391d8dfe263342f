package skein.testing

import scala.concurrent.duration.*

/** Marks slow suites; the time limit of their tests is long enough to stop only tests that hang. */
trait Unhurried extends munit.FunSuite:
  override def munitTimeout: Duration = 10.minutes
