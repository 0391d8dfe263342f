package skein.flight

import skein.loop.LoopKind
import skein.measure.Twin
import skein.report.SummaryTables
import skein.testing.{Lengthy, Timing}

/** Real sockets and real time: one flight over the emulated direct link and its twins in virtual time.
  *
  * A loaded machine increases the age of data: the test allows for each millisecond by which its mean age
  * exceeds the twins'. It shifts the distribution of ages by about 6 % of its height, and widens the orbit by
  * 0.6 %. On a quiet machine the allowance is 2 % of the distance and 0.2 between the distributions. Where
  * data is older by more than [[mostExcessMs]], hardly any two distributions would be too far apart: such a
  * flight is inconclusive. [[checkTwins]] requires 2 % of full flights, without allowance.
  */
class TwinLiveSuite extends munit.FunSuite, Lengthy, Timing:

  private val mostExcessMs = 6.0

  test("a live flight and its virtual twins have equal ages of data and converge to equal distances"):
    // A busy machine can also disturb a flight without making data older; not every time.
    val (busy, agreed) = Iterator.continually(compared()).take(3).span(!_.agrees)
    val flown          = busy.toVector ++ agreed.take(1)
    // .ci/run counts such lines.
    if !flown.exists(_.isCalm) then
      println(
        s"INCONCLUSIVE: the machine was busy, data older than the twins' by ${flown.map(_.excessMs)} ms"
      )
    assume(flown.exists(_.isCalm), "inconclusive")
    assert(flown.exists(_.agrees), s"flights disagree with their twins: ${flown.map(_.problems)}")

  /** @param excessMs mean age of data beyond that of the twins
    * @param problems differences between one live flight and its twins
    */
  private final case class Compared(excessMs: Double, problems: Vector[String]):
    def isCalm: Boolean = excessMs <= mostExcessMs
    def agrees: Boolean = isCalm && problems.isEmpty

  private def compared(): Compared =
    val settings = TwinFlights.settings(List(LoopKind.Stream), seconds = 30)
    val flights  = TwinFlights.fly(settings, twins = 3).fold(fail(_), identity)
    println(SummaryTables.twins(flights).render)
    val twin = flights.twins match
      case Vector(twin) => twin
      case others       => fail(s"expected one flight with its twins, got ${others.size}")
    val ages     = twin.compared.filter(_.quantity == Twin.Age)
    val excessMs = ages.map(age => age.live.mean - age.virtual.mean).max.max(0)
    assertEquals(twin.compared.size, 4)
    val apart = twin.compared
      .filter(_.distance > 0.2 + 0.06 * excessMs)
      .map(one => s"$excessMs ms older; ${one.role}, ${one.quantity}: ${one.distance}")
    val difference = twin.difference.getOrElse(fail("no distances"))
    val distance   = Option.when(difference.abs > 0.02 + 0.01 * excessMs)(
      s"$excessMs ms older: ${twin.converged}"
    )
    Compared(excessMs, apart.toVector ++ distance)
