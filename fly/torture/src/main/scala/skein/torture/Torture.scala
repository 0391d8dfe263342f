package skein.torture

import skein.flight.InParallel
import skein.scenario.Scenario
import skein.settings.NamedScene
import skein.units.*

/** What one flight through faults did wrong; nothing where it is clean. */
final case class FaultVerdict(faultPlan: FaultPlan, violations: Vector[String]):
  def isClean: Boolean = violations.isEmpty

/** Seeded flights through faults, each checked from outside. */
object Torture:

  /** Flies the fault plan of one seed. A flight that cannot be flown to its end is a violation, too. */
  def of(
      seed: Long,
      duration: Span,
      scenario: Option[Scenario] = None,
      scene: Option[NamedScene] = None
  ): FaultVerdict =
    val drawn = plan(seed, duration, scenario, scene)
    FaultVerdict(drawn, violations(Checks.violations(TortureFlight.fly(drawn))))

  /** What happens to the flight of a seed. */
  def plan(seed: Long, duration: Span, scenario: Option[Scenario], scene: Option[NamedScene]): FaultPlan =
    val drawn = FaultPlan.of(seed, duration)
    val flown = scenario.fold(drawn)(drawn.flying)
    scene.orElse(NamedScene.shipped(flown.scenario.scene)).fold(flown)(in => flown.copy(scene = in))

  /** Whatever is thrown, stack overflow and want of memory included: no seed may be lost. */
  private[torture] def violations(found: => Vector[String]): Vector[String] =
    try found
    catch case error: Throwable => Vector(error.toString)

  /** Flies many, as many at once as there are `threads`. Blocks.
    *
    * @param scenario that is flown; without one, duels
    * @param scene what stands in the world; without one, what the scenario says
    * @param onVerdict told of each as it comes, on the calling thread
    */
  def all(
      seeds: Iterator[Long],
      duration: Span,
      threads: Int,
      scenario: Option[Scenario] = None,
      scene: Option[NamedScene] = None
  )(onVerdict: FaultVerdict => Unit): Unit =
    InParallel.asTheyCome(seeds, threads)(of(_, duration, scenario, scene))(onVerdict)
