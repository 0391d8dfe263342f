package skein.testing

import scala.concurrent.duration.*

/** Takes long on a busy machine: its tests are ended only where they hang. */
trait Unhurried extends munit.FunSuite:
  override def munitTimeout: Duration = 10.minutes
