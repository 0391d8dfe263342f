package skein.environment

import java.nio.ByteBuffer
import java.util.stream.IntStream
import scala.util.Try
import skein.lanes.Engine
import skein.lanes.LearnerDuels.WORLDS
import skein.policy.HeadingPolicy
import skein.scenario.Scenarios
import skein.settings.PolicyFile
import skein.simd.LaneMath
import skein.units.Expect

/** Many episodes, step by step. A side of the duel or both, or a side of another scenario, are decided for
  * from outside ([[EnvironmentSettings]]), at the moments at which the loop decides, on readings as old as
  * the link makes them. Observations and actions are in [[EnvironmentBuffers]].
  *
  * A step is one decision. Its reward is, for a pursuer, minus the distances scored since the last one (once
  * a period), divided by 10 m, and 10 for a capture; for an evader the opposite. So the pursuer's rewards of
  * an episode without a capture sum to minus its mean distance, as `./skein search` has it, times the number
  * of periods, divided by 10 m.
  *
  * In other scenarios something else may be rewarded in the place of the distance.
  *
  * The duel flies by lanes, [[DuelGroup]]. Other scenarios are flown by the scalar reference,
  * [[ScenarioGroup]]: one vehicle of each environment is decided for, the others of its role fly their own
  * policies, or what [[fly]] says.
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

  /** In other scenarios than the duel: what those of the learner's role fly for whom nobody outside decides,
    * from their next episodes on.
    */
  def fly(policy: HeadingPolicy): Unit = groups.foreach:
    case team: ScenarioGroup => team.fly(policy)
    case _                   => ()

  /** Ends all episodes; nothing may be called any more. */
  def close(): Unit = groups.foreach(_.close())

  /** Every environment begins anew.
    *
    * @param seeds one each; a negative one: the environment goes on with its own
    */
  def reset(seeds: Array[Long]): Unit =
    require(seeds.length == count, s"expected $count seeds, came ${seeds.length}")
    groups.foreach(_.reset(seeds))
    isReset = true

  /** Those of the mask begin anew. */
  def reset(seeds: Array[Long], mask: Array[Boolean]): Unit =
    require(seeds.length == count && mask.length == count, s"expected $count seeds and as long a mask")
    require(isReset, "expected a reset of all environments before one of some")
    groups.foreach(_.reset(seeds, mask))

  /** One step of every environment.
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

  /** Fewer groups are flown by the caller's thread alone. */
  private val Together = 4

  /** What flies environments of the paper's game. */
  val EngineOfGame: Engine = Engine(Engine.Kind.Lanes, s"SIMD, ${LaneMath.LANES} environments at a time")

  /** What flies those of another scenario. */
  def engineOf(scenario: String): Engine =
    Engine.scalar(s"environments of $scenario fly one by one; those of the duel fly by SIMD")

  /** @param opponent of the side that does not learn; without one, as the settings name it
    * @return or what was expected and came
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

  /** The same from names and texts, for callers of other languages.
    *
    * @param settings by the names of [[EnvironmentSettings]] in snake case; what is missing is the default
    * @throws IllegalArgumentException with what was expected and came
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
