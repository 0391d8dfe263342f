package skein.link

import org.apache.pekko.NotUsed
import org.apache.pekko.stream.scaladsl.Flow
import org.apache.pekko.util.ByteString
import skein.signal.SplitMix64

/** Cuts a byte stream into segments. TCP guarantees no boundaries, and readers must not depend on them. */
private[link] object Segments:

  /** Cuts each segment at up to three places, determined by the seed. */
  def cut(seed: Long): Flow[ByteString, ByteString, NotUsed] = Flow[ByteString].statefulMapConcat: () =>
    val random = SplitMix64(seed)
    bytes => pieces(bytes, random)

  private def pieces(bytes: ByteString, random: SplitMix64): List[ByteString] =
    val places = List.fill(random.nextInt(4))(random.nextInt(bytes.size.max(1)))
    val edges  = (0 :: bytes.size :: places).distinct.sorted
    edges.zip(edges.drop(1)).map(bytes.slice(_, _))
