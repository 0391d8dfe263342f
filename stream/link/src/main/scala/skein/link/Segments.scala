package skein.link

import org.apache.pekko.NotUsed
import org.apache.pekko.stream.scaladsl.Flow
import org.apache.pekko.util.ByteString
import skein.signal.SplitMix64

/** Where a byte stream is cut into segments. TCP promises nothing about it, and what reads from it must not
  * care.
  */
private[link] object Segments:

  /** Cuts what comes at up to three places anywhere, decided by the seed. */
  def cut(seed: Long): Flow[ByteString, ByteString, NotUsed] = Flow[ByteString].statefulMapConcat: () =>
    val random = SplitMix64(seed)
    bytes => pieces(bytes, random)

  private def pieces(bytes: ByteString, random: SplitMix64): List[ByteString] =
    val places = List.fill(random.nextInt(4))(random.nextInt(bytes.size.max(1)))
    val edges  = (0 :: bytes.size :: places).distinct.sorted
    edges.zip(edges.drop(1)).map(bytes.slice(_, _))
