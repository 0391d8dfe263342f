package skein.scenario

import scala.util.control.NonFatal
import skein.policy.{Observation, Seen}
import skein.signal.{Kinematics, SplitMix64}
import skein.units.*

/** Creates scenario files with random mistakes. */
private object ScenarioMutants:
  private val Words = Vector(
    "-1",
    "999999999999",
    "1e999",
    "NaN",
    "0",
    "7",
    "",
    "does",
    "when",
    "add",
    "where",
    "lt",
    "not",
    "memory",
    "ahead",
    "elapsed",
    "\"",
    "\\",
    "\u0000",
    "𝔸",
    "vehicle",
    "wants 1 1 1 1",
    "over",
    "limit polygon 1 1 1 1 1 1",
    "heading"
  )

  /** Changes one to three words, letters or lines of a file. */
  def mutant(of: String, random: SplitMix64): String =
    def below(most: Int) = (random.nextDouble() * most).toInt.min(most - 1).max(0)
    (0 to below(3)).foldLeft(of): (text, _) =>
      val lines               = text.split("\n", -1).toVector
      val (line, word)        = (below(lines.size), Words(below(Words.size)))
      val words               = lines(line).split(" ", -1).toVector
      val at                  = below(words.size)
      def changed(by: String) = lines.updated(line, by).mkString("\n")
      below(7) match
        case 0 => changed(words.updated(at, word).mkString(" "))
        case 1 => changed(words.patch(at, Vector(word), 0).mkString(" "))
        case 2 => changed(words.patch(at, Nil, 1).mkString(" "))
        case 3 => lines.patch(line, Nil, 1).mkString("\n")
        case 4 => lines.patch(below(lines.size), Vector(lines(line)), 0).mkString("\n")
        case 5 =>
          if text.isEmpty then text else text.updated(below(text.length), (32 + below(96)).toChar)
        case _ => text.take(below(text.length + 1))

  /** Reads mutated files, and simulates one decision of those that are valid.
    *
    * @return number of valid files
    */
  def check(of: String, seed: Long, count: Int)(wrong: (String, String) => Nothing): Int =
    val random = SplitMix64(seed)
    var whole  = 0
    for number <- 0 until count do
      val text = mutant(of, random)
      try
        ScenarioText.read(text) match
          case Left(why) =>
            if why.isEmpty || why.length > 500 || why.exists(_.isControl) then wrong(text, s"$number: $why")
          case Right(kind) =>
            whole += 1
            decide(kind.standard)
      catch case NonFatal(failure) => wrong(text, s"$number: $failure")
    whole

  private def decide(scenario: Scenario): Unit =
    val agents = scenario.agents
    val still  = Kinematics(Vector3(1, 2, -5), Vector3.Zero, Quaternion.Identity, Vector3.Zero)
    val seen   = agents.map(_ => Seen(still, Span.Zero, isPredicted = false))
    for (agent, self) <- agents.zipWithIndex do
      val now = Observation(
        self,
        seen,
        0,
        agents.map(_.startHeading),
        Span.Zero,
        0,
        agent.speed,
        Metres(agent.startPositionNed.z)
      )
      val _ = agent.policy.choose(now, agent.policy.start)
    val _ = scenario.isOver(Known(Span.Zero, seen))
