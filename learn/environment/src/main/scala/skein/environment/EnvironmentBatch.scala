package skein.environment

import java.nio.ByteBuffer
import java.util.stream.IntStream
import scala.util.Try
import skein.lanes.Engine
import skein.lanes.LearnerDuels.WORLDS
import skein.policy.Policy
import skein.scenario.{ScenarioText, Scenarios}
import skein.settings.PolicyFile
import skein.simd.LaneMath
import skein.units.Expect

/** Many episodes, simulated step by step. The caller decides for one or both sides of the duel, or for a side
  * of another scenario ([[EnvironmentSettings]]), at the times at which the loop decides, on readings with
  * the age that the link causes. Observations and actions are in [[EnvironmentBuffers]].
  *
  * A step is one decision. Its reward is, for a pursuer, minus the distances scored since the last one (once
  * a period), divided by 10 m, and 10 for a capture; for an evader the opposite. So the pursuer's rewards of
  * an episode without a capture sum to minus its mean distance, as `./skein search` has it, times the number
  * of periods, divided by 10 m.
  *
  * In other scenarios another quantity may be rewarded instead of the distance.
  *
  * The duel uses SIMD, [[DuelGroup]]. Other scenarios use the scalar reference, [[ScenarioGroup]]: the caller
  * decides for one vehicle of each environment; the others of its role use their own policies, or that of
  * [[fly]].
  *
  * One call at a time. A step of the duel allocates nothing, except where many groups share the processors.
  *
  * @param count of environments
  * @param block of [[EnvironmentBuffers.bytes]]
  */
final class EnvironmentBatch private (
    config: EnvironmentSettings.Resolved | ScenarioSide,
    val count: Int,
    autoreset: Autoreset,
    block: ByteBuffer
) extends AutoCloseable:
  private val groups: Array[EnvironmentGroup] = config match
    case duel: EnvironmentSettings.Resolved =>
      val timetables = EnvironmentTimetables(duel)
      val buffers    = EnvironmentBuffers(block, duel.learners.size, count)
      Array.tabulate((count + WORLDS - 1) / WORLDS): group =>
        val first = group * WORLDS
        DuelGroup(duel, timetables, autoreset, first, (count - first).min(WORLDS), buffers)
    case side: ScenarioSide =>
      Array(ScenarioGroup(side, autoreset, count, EnvironmentBuffers(block, 1, count)))
  private var isReset = false

  /** What flies the environments. */
  val engine: Engine = config match
    case _: EnvironmentSettings.Resolved => EnvironmentBatch.EngineOfGame
    case side: ScenarioSide              => EnvironmentBatch.engineOf(side.settings.scenario)

  /** Sets, in other scenarios than the duel, the policy of the learner's role for vehicles without a learner,
    * from their next episodes on.
    */
  def fly(policy: Policy): Unit = groups.foreach:
    case team: ScenarioGroup => team.fly(policy)
    case _                   => ()

  /** Ends all episodes; no method may be called afterwards. */
  def close(): Unit = groups.foreach(_.close())

  /** Resets every environment.
    *
    * @param seeds one for each environment; a negative one continues the environment's own sequence
    */
  def reset(seeds: Array[Long]): Unit =
    require(seeds.length == count, s"expected $count seeds, came ${seeds.length}")
    groups.foreach(_.reset(seeds))
    isReset = true

  /** Resets the environments of the mask, with their seeds. */
  def reset(seeds: Array[Long], mask: Array[Boolean]): Unit =
    require(seeds.length == count && mask.length == count, s"expected $count seeds and as long a mask")
    require(isReset, "expected a reset of all environments before one of some")
    groups.foreach(_.reset(seeds, mask))

  /** Advances every environment by one step.
    *
    * @throws IllegalArgumentException if an action is not finite; then nothing was done
    * @throws IllegalStateException if an episode has ended, and was not reset
    */
  def step(): Unit =
    if !isReset then throw IllegalStateException("expected reset() before the first step()")
    var i = 0
    while i < groups.length do
      val misfit = groups(i).misfit()
      if misfit >= 0 then
        throw IllegalArgumentException(
          s"action of environment $misfit: expected a number from -1 to 1, came none"
        )
      val ended = groups(i).ended
      if ended >= 0 then
        throw IllegalStateException(s"environment $ended has ended; reset it before the next step()")
      i += 1
    // A step lasts microseconds: the common pool hands out its parts without a thread being started or woken
    // by us.
    if groups.length < EnvironmentBatch.Together then groups.foreach(_.step())
    else IntStream.range(0, groups.length).parallel().forEach(groups(_).step())

object EnvironmentBatch:
  val Most = 1 << 20

  /** Groups from which on several threads are used. */
  private val Together = 4

  /** What flies environments of the paper's game. */
  val EngineOfGame: Engine = Engine(Engine.Kind.Lanes, s"SIMD, ${LaneMath.LANES} environments at a time")

  /** What flies those of another scenario. */
  def engineOf(scenario: String): Engine =
    Engine.scalar(
      s"environments of ${ScenarioText.called(scenario)} fly one by one; those of the duel fly by SIMD"
    )

  /** @param opponent of the side that does not learn; without one, as the settings name it
    * @return Left states what was expected and what was given
    */
  def of(
      settings: EnvironmentSettings,
      count: Int,
      autoreset: Autoreset,
      block: ByteBuffer,
      opponent: Option[PolicyFile] = None
  )(using scenarios: Scenarios): Either[String, EnvironmentBatch] =
    for
      config <-
        if scenarios.isPapersGame(settings.scenario, settings.set) then settings.resolvedAgainst(opponent)
        else ScenarioSide.of(settings)
      _    <- Expect.that(count >= 1 && count <= Most)(s"num_envs: expected 1 to $Most, came $count")
      made <- Try(new EnvironmentBatch(config, count, autoreset, block)).toEither.left.map(_.getMessage)
    yield made

  /** Makes a batch from names and texts, for callers in other languages.
    *
    * @param settings by the names of [[EnvironmentSettings]] in snake case; missing ones have their defaults
    * @throws IllegalArgumentException with what was expected and what was given
    */
  def make(
      settings: java.util.Map[String, String],
      count: Int,
      autoreset: Int,
      block: ByteBuffer
  ): EnvironmentBatch =
    EnvironmentSettings
      .read(settings)
      .flatMap(of(_, count, Autoreset.fromOrdinal(autoreset), block)(using Scenarios.ours))
      .fold(mistake => throw IllegalArgumentException(mistake), identity)
