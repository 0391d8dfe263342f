package skein.vtime

import java.lang.management.ManagementFactory
import scala.concurrent.Future
import scala.jdk.CollectionConverters.*

/** Runs a main method in a separate JVM. */
private object OtherJvm:

  def run(
      main: String,
      arguments: Seq[String] = Nil,
      withAgent: Boolean = true,
      agentOption: String = ""
  ): String =
    val java  = ProcessHandle.current.info.command.get
    val agent =
      ManagementFactory.getRuntimeMXBean.getInputArguments.asScala.find(_.startsWith("-javaagent:")).get
    val options = Option.when(withAgent)(agent + agentOption)
    val brief   = Seq("-XX:TieredStopAtLevel=1", "-XX:+UseSerialGC")
    val command =
      Seq(java) ++ brief ++ options ++ Seq("-cp", System.getProperty("java.class.path"), main) ++ arguments
    val process = ProcessBuilder(command.asJava).redirectErrorStream(true).start()
    val lines   = String(process.getInputStream.readAllBytes()).linesIterator.toSeq
    assert(process.waitFor() == 0, lines.mkString("\n"))
    lines.last

@main def sampleGraphDigest(seed: Long): Unit = println(SampleGraph.digest(seed))

@main def withoutAgent(): Unit =
  try VirtualTime.run(1)(_ => Future.unit): Unit
  catch case refused: VirtualTimeException => println(s"refused: ${refused.getMessage.replace("\n", " ")}")
