package skein.rpc

import org.apache.pekko.actor.ActorSystem
import skein.airsim.ImageFuzz
import skein.link.PreciseScheduler

/** The long fuzz: mutated byte sequences against the codec, the reader of images and scans, a live server and
  * a live client. Fails with an error that names the seed when anything crashes, hangs, or has a wrong
  * result.
  *
  * Arguments: sequences for the codec and for the reader (default 1,000,000), for each of server and client
  * (default 20,000), the first seed (default 1).
  */
object Fuzz:
  def main(args: Array[String]): Unit =
    val codecSequences = args.headOption.fold(1_000_000)(_.toInt)
    val liveSequences  = args.lift(1).fold(20_000)(_.toInt)
    val seed           = args.lift(2).fold(1L)(_.toLong)
    val started        = System.nanoTime()
    def elapsed        = f"${(System.nanoTime() - started) * 1e-9}%.1f s, ${heapMiB()} MiB of heap in use"

    println(s"at the start: $elapsed")
    println(s"${CodecFuzz.run(codecSequences, seed)}; $elapsed")
    println(s"${ImageFuzz.run(codecSequences, seed)}; $elapsed")
    given system: ActorSystem = ActorSystem("fuzz", PreciseScheduler.config)
    println(s"${PairFuzz.server(liveSequences, seed)}; $elapsed")
    println(s"${PairFuzz.client(liveSequences, seed)}; $elapsed")
    val _ = system.terminate()

  private def heapMiB(): Long =
    System.gc()
    (Runtime.getRuntime.totalMemory - Runtime.getRuntime.freeMemory) >> 20
