package skein.benchmark

import com.typesafe.config.{ConfigFactory, ConfigUtil}
import skein.scenario.{ScenarioText, Scenarios}
import skein.settings.FlySettings

/** The flights of a benchmark: every entry in every task, over every link, in every world.
  *
  * @param tasks scenarios with their settings, as HOCON of `skein.fly`
  * @param worlds deviations of vehicle and air from the model: `plant` of `skein.fly`
  */
final case class BenchmarkSet(
    tasks: Vector[BenchmarkSet.Named],
    links: Vector[String],
    worlds: Vector[BenchmarkSet.Named],
    entries: Vector[BenchmarkSet.Entry]
):
  /** The cells of the result, in the order of its rows. */
  def cells: Vector[BenchmarkSet.Cell] =
    for task <- tasks; world <- worlds; link <- links yield BenchmarkSet.Cell(task, world, link)

  /** Adds all entries with each of these policies, in the text form of `--policy` of `./skein fly`. */
  def flownBy(policies: Seq[String]): BenchmarkSet =
    val names = FlySettings.numbered(policies.map(policy => policy.substring(policy.lastIndexOf('/') + 1)))
    copy(entries = entries ++ policies.zip(names).flatMap: (policy, name) =>
      entries.map(entry => entry.copy(name = s"${entry.name}, $name", policy = Some(policy))))

  /** The tasks whose scenarios a program knows; if there are none, its own scenarios. */
  def tasksOf(program: Scenarios): Vector[BenchmarkSet.Named] =
    val known = tasks.filter(task => program.names.contains(task.scenario))
    if known.isEmpty then program.names.map(BenchmarkSet.Named.of) else known

object BenchmarkSet:
  /** To be raised when any figure may change: results of different versions are not compared. */
  val Version = 3

  /** A name in the table, and the text of its settings. */
  final case class Named(name: String, text: String):
    /** The scenario of a task. */
    def scenario: String = ConfigFactory.parseString(text).getString("scenario")

  object Named:
    /** A scenario as a task.
      *
      * @param name the name of the scenario's kind, or the text of its file
      */
    def of(name: String): Named =
      Named(ScenarioText.called(name), s"scenario = ${ConfigUtil.quoteString(name)}")

  /** A loop, with the model by which it predicts.
    *
    * @param isInPacket whether each command carries the actions foreseen after it
    * @param policy the policy that replaces the scenario's own policy, in the text form of `--policy` of
    *   `./skein fly`
    */
  final case class Entry(
      name: String,
      loop: String,
      predictor: String = "quadrotor",
      isInPacket: Boolean = false,
      policy: Option[String] = None
  )

  /** The loop that all entries are compared with. */
  val Truth: Entry = Entry("truth", "paused")

  final case class Cell(task: Named, world: Named, link: String):
    /** The part of a cell on which paused flights depend: they use no link. */
    def ofTruth: (Named, Named) = (task, world)

    /** The settings of an entry's flights.
      *
      * @return Left lists the mistake in the cell's texts
      */
    def settings(entry: Entry, seed: Long)(using Scenarios): Either[String, FlySettings] =
      val policy = entry.policy.map(ConfigUtil.quoteString)
      val text   =
        s"""skein.fly { ${task.text}, plant = "${world.text}", links = ["$link"], seed = $seed
           |  loops = [${entry.loop}], predictor = ${entry.predictor}, plan-in-packet = ${entry.isInPacket}
           |  policies = [${policy.mkString}], only-policies = ${policy.isDefined} }""".stripMargin
      FlySettings
        .read(
          ConfigFactory.parseString(text).withFallback(ConfigFactory.load()).resolve.withOnlyPath("skein.fly")
        )
        .left
        // Line numbers of this text mean nothing to a user.
        .map(_.replaceFirst("""^String: \d+: skein\.fly\.[\w.-]+: """, ""))

  /** The set of `./skein benchmark`, of [[Version]]. */
  val Published: BenchmarkSet = BenchmarkSet(
    tasks = Vector("duel", "surround", "formation", "crossing", "shadow").map(Named.of) :+
      Named("hidden-shadow", "scenario = shadow, knows = positions"),
    links = Vector("direct", "vpn", "constant:200ms", "constant:400ms", "loss:5%/4,vpn"),
    worlds = Vector(
      Named("as modelled", "airsim"),
      Named("wind", "airsim:wind=8/0/0,gusts=7.7"),
      Named("another vehicle", "airsim:mass=1.3,drag=2,lag=1.5,wind=8/0/0")
    ),
    entries = Vector(
      Entry("sequential", "sequential"),
      Entry("stream", "stream"),
      Entry("straight on", "predictive", "constant-velocity"),
      Entry("model", "predictive"),
      Entry("adaptive", "predictive", "adaptive"),
      Entry("plans in packets", "predictive", isInPacket = true)
    )
  )
