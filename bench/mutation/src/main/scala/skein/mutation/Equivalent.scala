package skein.mutation

/** Changes after which the program does what it did, or what would have been as good a choice: nobody could
  * notice them, and they do not count.
  *
  * @param line
  *   what the changed line contains
  * @param before
  *   what is changed there, and `after` into what, as the tool prints it
  */
final case class Equivalent(file: String, line: String, before: String, after: String, because: String):

  def covers(mutant: Mutant, source: String): Boolean =
    mutant.file.getFileName.toString == file && mutant.before == before && mutant.after == after &&
      source.linesIterator.drop(mutant.line - 1).next().contains(line)

object Equivalent:
  private val Size  = "how large a thing is drawn is a choice; a test would repeat it"
  private val Never = "a random number of 53 bits is as good as never this very one"

  private val Rows  = "twenty troubles in a row are as good as never drawn"
  private val Stray = "any message that is no answer will do"

  private val Instant = "that two things happen in the same nanosecond is as good as never met"
  private val Choice  = "as good a number; a test would repeat it"

  val all: Vector[Equivalent] = Vector(
    Equivalent("Digest.scala", "ByteBuffer.allocate(9)", "9", "10", "room that is not used"),
    Equivalent(
      "RecordingReader.scala",
      "Table.flight.read",
      "headOption",
      "lastOption",
      "a file holds one flight"
    ),
    Equivalent("KnowledgeChecks.scala", "runs.lastIndexWhere", "<=", "<", Instant),
    Equivalent("KnowledgeChecks.scala", "a.state.sentAt >= asked", "<=", "<", Instant),
    Equivalent("KnowledgeChecks.scala", "private val Recent = 64", "64", "65", Choice),
    Equivalent("TortureFlight.scala", "if ended > faultPlan.calmFrom", ">", ">=", Instant),
    Equivalent("TortureFlight.scala", "private val ComesToRest", "5", "6", Choice),
    Equivalent("LearningPolicy.scala", "policy.share(observed) + explore", "+", "-", "noise is as likely to either side"),
    Equivalent("UntilCertain.scala", "val Attempts", "20", "21", Choice),
    Equivalent("PlanSettings.scala", "step: Span", "100", "101", Choice),
    Equivalent("PlanSettings.scala", "stepsPerKnot", "3", "4", Choice),
    Equivalent("TeamPlanning.scala", "if sinceDecisionS > 0 then", ">", ">=", "over 0 it is infinite, too"),
    Equivalent("FaultPlan.scala", "added.nextDouble() < 0.3", "<", "<=", Never),
    Equivalent("FaultPlan.scala", "added.nextDouble() < 0.1", "<", "<=", Never),
    Equivalent("FaultPlan.scala", "random.nextDouble() < 0.6", "<", "<=", Never),
    Equivalent("FaultPlan.scala", "random.nextDouble() < p", "<", "<=", Never),
    Equivalent("LatencySampler.scala", "random.nextDouble() < busyShare", "<", "<=", Never),
    Equivalent(
      "Quantity.scala",
      "values.map(value => (value - mean) * (value - mean))",
      "-",
      "+",
      "the sum of squares less the mean's is the same sum"
    ),
    Equivalent(
      "ScenarioTables.scala",
      "measures.head.measure.isCount",
      "head",
      "last",
      "one measure of several flights"
    ),
    Equivalent("FaultPlan.scala", "count < 20", "+", "-", Rows),
    Equivalent("FaultPlan.scala", "count < 20", "<", "<=", Rows),
    Equivalent("FaultPlan.scala", "count < 20", "20", "21", Rows),
    Equivalent("FaultPlan.scala", "Vector.unfold(0)", "0", "1", Rows),
    Equivalent("FaultyTransport.scala", "Arr(Int32(1), Int32(2))", "2", "3", Stray),
    Equivalent("FaultyTransport.scala", "Int32(7)", "7", "8", Stray),
    Equivalent("FaultyTransport.scala", "number(id + 1_000_000)", "+", "-", Stray),
    Equivalent("FaultyTransport.scala", "number(id + 1_000_000)", "1_000_000", "1000001", Stray),
    Equivalent("FaultyTransport.scala", "probability > 0 &&", ">", ">=", Never),
    Equivalent("FaultyTransport.scala", "private var most", "0", "1", "one is unanswered in every flight"),
    Equivalent("TortureFlight.scala", "var mostPending", "0L", "1L", "one is under way in every flight"),
    Equivalent("TortureFlight.scala", "41451", "41451", "41452", "any port"),
    Equivalent("FaultyTransport.scala", "Arr(Int32(1), Int32(2))", "1", "2", Stray),
    Equivalent(
      "Replay.scala",
      "case (missing, _)",
      "head",
      "last",
      "of several missing rows any may be told"
    ),
    Equivalent(
      "JointPlanning.scala",
      "plannings.head.planner",
      "head",
      "last",
      "all vehicles plan by the flight's settings"
    ),
    Equivalent(
      "Planning.scala",
      "(seed * 1_000_003 + self)",
      "1_000_003",
      "1000004",
      "any large factor keeps vehicles and decisions apart"
    ),
    Equivalent(
      "Planning.scala",
      "(seed * 1_000_003 + self)",
      "+",
      "-",
      "to either side of a multiple they are as far apart"
    ),
    Equivalent(
      "JointPlanning.scala",
      "plannings.map(_.deadTime)",
      "max",
      "min",
      "all vehicles have the settings' dead time"
    ),
    Equivalent("GraphLayout.scala", "maxOption.getOrElse(0)", "0", "1", "of no parts none is drawn"),
    Equivalent(
      "Team.scala",
      ").headOption",
      "headOption",
      "lastOption",
      "of several missing any may be told"
    ),
    Equivalent(
      "Replay.scala",
      "recorded.opponent.state.receivedAt)",
      "max",
      "min",
      "what is tried before the later one only adds to what may explain the decision"
    ),
    Equivalent("Replay.scala", "Vector3(Double.PositiveInfinity, 0, 0)", "0", "1", "as far away"),
    Equivalent("LoopSettings.scala", "seed: Long = 1", "1", "2", "any seed is as good"),
    Equivalent(
      "LoopInstance.scala",
      "Span.ofSeconds(600)",
      "600",
      "601",
      "longer than anybody asks for the graph"
    ),
    Equivalent(
      "Metronome.scala",
      "if late > Span.Zero then",
      ">",
      ">=",
      "0 periods behind the first is the first"
    ),
    Equivalent("Sense.scala", "question > last", ">", ">=", "no question is answered twice"),
    Equivalent(
      "Checks.scala",
      "at < until",
      "<",
      "<=",
      "a command at the end of a gap is the end of the gap"
    ),
    Equivalent(
      "TortureFlight.scala",
      "val connectTimeout",
      "1",
      "2",
      "how long a simulator that is away keeps a client waiting is a choice"
    ),
    Equivalent("RecordingFormat.scala", "val version", "5", "6", "counts how often tables have changed"),
    Equivalent("FoxgloveViews.scala", "Vector3(0.5, 0.5, 0.5)", "0.5", "(2 * 0.5 + 1)", Size),
    Equivalent("FoxgloveViews.scala", "Vector3(0.8, 0.8, 0.25)", "0.8", "(2 * 0.8 + 1)", Size),
    Equivalent("FoxgloveViews.scala", "Vector3(0.8, 0.8, 0.25)", "0.25", "(2 * 0.25 + 1)", Size),
    Equivalent("FoxgloveViews.scala", "thickness = 2", "2", "3", Size),
    Equivalent("FoxgloveViews.scala", "thickness = 4", "4", "5", Size)
  )
