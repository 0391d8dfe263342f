package skein.torture

import skein.testing.Unhurried
import skein.units.*

/** Seeds with earlier violations, by the loop or in the checks. */
class RestartSimulation extends munit.FunSuite, Unhurried:
  test(
    "restarts before or between the readings of one step, or during an answer, break no rule"
  ):
    for seed <- Seq(1851L, 2989L, 4876L, 6961L, 8167L, 8823L) do
      assertEquals(Torture.of(seed, Span.ofSeconds(60)).violations, Vector.empty, s"seed $seed")
