package skein.torture

import skein.flight.InParallel
import skein.scenario.Scenario
import skein.settings.NamedScene
import skein.units.*

/** The violations of one flight with faults; empty if there are none. */
final case class FaultVerdict(faultPlan: FaultPlan, violations: Vector[String]):
  def isClean: Boolean = violations.isEmpty

/** Simulates seeded flights with faults, each checked from outside. */
object Torture:

  /** Runs the fault plan of one seed. A flight that fails is a violation, too. */
  def of(
      seed: Long,
      duration: Span,
      scenario: Option[Scenario] = None,
      scene: Option[NamedScene] = None
  ): FaultVerdict =
    val drawn = plan(seed, duration, scenario, scene)
    FaultVerdict(drawn, violations(Checks.violations(TortureFlight.fly(drawn))))

  def plan(seed: Long, duration: Span, scenario: Option[Scenario], scene: Option[NamedScene]): FaultPlan =
    val drawn = FaultPlan.of(seed, duration)
    val flown = scenario.fold(drawn)(drawn.flying)
    scene.orElse(NamedScene.shipped(flown.scenario.scene)).fold(flown)(in => flown.copy(scene = in))

  /** Collects violations; any exception counts as one, stack overflow and lack of memory included: no seed
    * may be lost.
    */
  private[torture] def violations(found: => Vector[String]): Vector[String] =
    try found
    catch case error: Throwable => Vector(error.toString)

  /** Runs many seeds on `threads` threads. Blocks.
    *
    * @param scenario the flights' scenario; by default duels
    * @param scene the scene of the simulator's world; by default the scenario's
    * @param onVerdict called with each result as soon as it is ready, on the calling thread
    */
  def all(
      seeds: Iterator[Long],
      duration: Span,
      threads: Int,
      scenario: Option[Scenario] = None,
      scene: Option[NamedScene] = None
  )(onVerdict: FaultVerdict => Unit): Unit =
    InParallel.asTheyCome(seeds, threads)(of(_, duration, scenario, scene))(onVerdict)
