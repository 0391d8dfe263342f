package skein.report

import skein.observe.{ObservedTopic, ObservedTopics}
import skein.report.ObservedTables.{ages, mean, p99, section}
import skein.units.Decimals.{brief, counted, fixed}

/** Measurements of a loop that exchanges messages on topics, as tables and sentences. */
object TopicTables:

  def tables(observed: ObservedTopics): Vector[Section] =
    Vector(vehicles(observed), topics(observed)).flatten

  /** Tables for scripts, with the findings. */
  def data(observed: ObservedTopics, findings: Vector[String]): Vector[Section] =
    tables(observed) ++ section("Findings", Vector("<finding"), findings.map(Vector(_)))

  private def vehicles(observed: ObservedTopics) = ages(
    observed.vehicles,
    unnamed = "(the only)",
    bounds =
      if observed.vehicles.forall(_.boundMs.isEmpty) then Vector.empty
      else Vector("± ms" -> (_.boundMs.fold("")(_.brief))),
    further = Vector.empty,
    "Ages count from the stamp of a reading to when the command was received; means, and 99th percentiles."
  )

  private def topics(observed: ObservedTopics) = section(
    "Topics",
    Vector("<topic", "<of", "messages", "a second", "every ms", "p99", "longest", "gaps") ++
      Vector("came after ms", "p99", "out of order"),
    observed.topics.map: topic =>
      Vector(
        topic.name,
        topic.kind.label,
        topic.messages.toString,
        topic.intervalMs.fold("")(all => if all.mean > 0 then (1e3 / all.mean).brief else ""),
        topic.intervalMs.fold("")(_.median.brief),
        p99(topic.intervalMs),
        topic.intervalMs.fold("")(_.most.brief),
        topic.gaps.toString,
        mean(topic.lateMs),
        p99(topic.lateMs),
        topic.backwards.toString
      ),
    "Every: the median; a gap is longer than two and a half of it. Came after: from a header's stamp to when its " +
      "message was received."
  )

  /** A paragraph for each finding, and one for the limits of an observation by topics. */
  def findings(observed: ObservedTopics): Vector[String] =
    def seconds(ms: Double)          = s"${(ms / 1e3).fixed(2)} s"
    def broken(topic: ObservedTopic) =
      s"${topic.name} had ${topic.gaps} gaps, the longest of ${seconds(topic.intervalMs.fold(0.0)(_.most))}."
    def disorder(topic: ObservedTopic) = s"${topic.name} came out of order ${topic.backwards} times."
    val assumed                        = Option.when(observed.commands > 0):
      if observed.caused == observed.commands then
        "Every command has the stamp of the reading that caused it."
      else if observed.caused == 0 then
        "No command has the stamp of a reading: the newest one received before it is assumed."
      else
        s"${observed.caused} of ${observed.commands} commands have the stamp of the reading that caused them; behind " +
          "the others the newest one received before is assumed."
    val clocks = Option.when(observed.byOtherClock.nonEmpty):
      s"The stamps of ${observed.byOtherClock.map(name => if name.isEmpty then "the vehicle" else name).mkString(", ")} are by " +
        "another clock than the times of reception: ages lack the way of the fastest message."
    val early = observed.vehicles.filter(_.early > 0).map: vehicle =>
      s"${counted(vehicle.early, "command")} to ${vehicle.name} passed before the first TIMESYNC was answered: the " +
        "ages behind them are not in the table."
    val ours = "Times are by the clock of the machine that received the messages."
    val time = observed.simulated.fold(ours): by =>
      val before =
        if by.before == 0 then "" else s" ${by.before} messages from before it began are not counted."
      s"Times are simulated, by /clock: known to within its step of ${by.step.toMillis.brief} ms.$before"
    val more = Option.when(observed.notKept > 0)(s"${observed.notKept} messages are not counted.")
    (if observed.commands == 0 then Vector("There is no command, so there is no loop to judge.")
     else Vector.empty) ++
      observed.topics.filter(_.gaps > 0).map(broken) ++ observed.topics.filter(
        _.backwards > 0
      ).map(disorder) ++
      assumed ++ clocks ++ early ++ Option.when(observed.topics.nonEmpty)(time) ++ more
