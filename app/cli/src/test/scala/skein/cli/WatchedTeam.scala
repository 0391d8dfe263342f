package skein.cli

import java.lang.management.ManagementFactory
import java.nio.file.{Files, Path}
import java.util.concurrent.Executors
import java.util.concurrent.locks.LockSupport
import scala.concurrent.{Await, ExecutionContext, Future}
import scala.concurrent.duration.*
import scala.util.Try
import skein.flight.VirtualFlights
import skein.loop.LoopKind
import skein.record.FlightTopics
import skein.scenario.Formation
import skein.settings.FlySettings
import skein.signal.LatencyProfile
import skein.units.*
import skein.view.{Feed, LiveShow, Shows, ViewServer}

/** Twenty vehicles at 20 Hz on the page in a real browser: processor time of the server's thread, and frames
  * that the page draws. The rows are those of a flight in virtual time, sent at their times, so that nothing
  * else runs here.
  *
  * On a busy machine the number of frames says little: then the processor time of all of the browser's
  * processes for one frame states how many one core could draw. `cli/Test/runMain skein.cli.watchedTeam 20
  * true`.
  *
  * @param plain whether the browser draws in plain software, else with software that imitates a graphics
  *   card, which costs more
  */
@main def watchedTeam(seconds: Int, plain: Boolean): Unit =
  val settings = FlySettings(
    List(LoopKind.Predictive),
    List(LatencyProfile.direct),
    Span.ofSeconds(seconds + 40.0),
    Span.ofMillis(50),
    seed = 1,
    Formation(vehicles = 20)
  )
  val recorder = VirtualFlights.fly(settings, settings.plans.last).fold(sys.error(_), _.recorder)
  val flown    = recorder.recording
  val told     = recorder.records
  println(
    s"${flown.heading.vehicles.size} vehicles, ${told.size} rows in ${settings.duration.toSeconds} s: " +
      s"${flown.readings.size} readings, ${flown.decisions.size} decisions, ${flown.commands.size} commands"
  )
  val threads = Executors.newSingleThreadExecutor(Thread.ofPlatform.daemon.name("skein-view").factory)
  val mine    =
    Await.result(Future(Thread.currentThread)(using ExecutionContext.fromExecutor(threads)), 5.seconds)
  val feed  = Feed()
  val shows = Shows()
  shows.add(LiveShow(flown.heading, feed))
  val server =
    Edge.await(ViewServer.start(shows, Clock.system, ExecutionContext.fromExecutor(threads), port = 0))
  @volatile var on = true
  val telling      = Thread.ofPlatform.daemon.start: () =>
    val began =
      System.nanoTime() - FlightTopics.knownAt(told.find(FlightTopics.knownAt(_).isDefined).get).get.toNanos
    for record <- told if on do
      for at <- FlightTopics.knownAt(record) do
        while on && System.nanoTime() - began < at.toNanos do LockSupport.parkNanos(2_000_000)
      feed.offer(record)
  val cpu = ManagementFactory.getThreadMXBean
  // The steps in the browser, with the processor time at their begin and end.
  val said = JavaScriptTools.packages.flatMap(packages =>
    JavaScriptTools.browser.flatMap: browser =>
      val task = ujson.Obj(
        "token" -> "",
        "plain" -> plain,
        "steps" -> ujson.Arr(
          ujson.Arr("wait", "window.skein?.flight?.vehicles.size === 20 && skein.flight.now > 3"),
          ujson.Arr("ask", "from", "[performance.now(), skein.frames]"),
          ujson.Arr("sleep", seconds * 1000),
          ujson.Arr("ask", "to", "[performance.now(), skein.frames]")
        )
      ).render()
      val asked =
        ProcessBuilder("node", JavaScriptTools.script("browser.mjs"), s"$packages", browser, server.url, task)
          .redirectError(ProcessBuilder.Redirect.INHERIT)
          .start()
      // Measured while the page is open: from some seconds after its start, for half of its time.
      while shows.all.head.watching == 0 && asked.isAlive do Thread.sleep(50)
      Thread.sleep(5000)
      val from = (System.nanoTime(), cpu.getThreadCpuTime(mine.threadId), browsing(asked))
      Thread.sleep(seconds * 500L)
      val to           = (System.nanoTime(), cpu.getThreadCpuTime(mine.threadId), browsing(asked))
      val text         = String(asked.getInputStream.readAllBytes)
      val wallS        = (to._1 - from._1) * 1e-9
      val serverShare  = (to._2 - from._2) * 1e-9 / wallS
      val browserShare = (to._3 - from._3) / wallS
      Right((ujson.read(text), serverShare, browserShare))
  )
  on = false
  telling.join(1000)
  Edge.await(server.close()): Unit
  val (seen, serverShare, browserShare) = said.fold(sys.error(_), identity)
  val answers                           = seen("told").obj
  val frames                            = answers("to")(1).num - answers("from")(1).num
  val tookS                             = (answers("to")(0).num - answers("from")(0).num) / 1000
  val rate                              = frames / tookS
  println(
    f"${if plain then "software" else "imitated card"}: server " +
      f"${serverShare * 100}%.1f %% of one core; page $rate%.1f frames a " +
      f"second; browser: ${browserShare * 100}%.0f %% of one core, " +
      f"${browserShare / rate * 1000}%.1f ms of processor time a frame; " +
      f"load ${load()}; problems: ${seen("problems")}"
  )

/** Processor time of a process and all its descendants, s. */
private def browsing(process: Process): Double =
  (process.toHandle +: process.descendants.toArray(new Array[ProcessHandle](_)).toVector)
    .flatMap(one => Try(Files.readString(Path.of(s"/proc/${one.pid}/stat"))).toOption)
    .map: stat =>
      val fields = stat.drop(stat.lastIndexOf(')') + 2).split(' ')
      (fields(11).toLong + fields(12).toLong) / 100.0
    .sum

private[cli] def load(): String =
  Try(Files.readString(Path.of("/proc/loadavg")).split(' ').take(2).mkString(" ")).getOrElse("?")
