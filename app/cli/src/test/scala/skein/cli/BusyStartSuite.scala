package skein.cli

import com.typesafe.config.ConfigFactory
import java.util.concurrent.TimeoutException

/** Start of commands on a busy machine. */
class BusyStartSuite extends munit.FunSuite:

  test("a start waits up to ten minutes, and an accepted connection up to a minute"):
    val config = ConfigFactory.load().getConfig("pekko")
    for (path, seconds) <- Seq(
        "logger-startup-timeout"               -> 600,
        "actor.creation-timeout"               -> 600,
        "stream.materializer.creation-timeout" -> 600,
        "io.tcp.register-timeout"              -> 60
      )
    do assertEquals(config.getDuration(path).toSeconds, seconds.toLong, path)

  test("a start-up that times out is reported in one line"):
    val late = TimeoutException("Future timed out after [600 seconds]")
    val ran  = Ran.of(Main.unexpected("serve", late))
    assertEquals(ran.status, 1)
    assertEquals(
      ran.said,
      "skein serve: given up before it began, for this machine has too much else to do: " +
        "Future timed out after [600 seconds]\n"
    )
