package skein.cluster

import com.typesafe.config.{Config, ConfigFactory, ConfigUtil}
import skein.link.Address

/** Makes the Pekko configuration of a node. */
private[cluster] object NodeConfig:
  val System = "skein"

  private val MostFrame = MessageCodec.MostBytes + (64 << 10)

  /** @param listen the endpoint to listen at; port 0 for any that is free
    * @param joins the endpoint to which it connects
    */
  def of(listen: Address, tls: Option[Tls], joins: Option[Address] = None): Either[String, Config] =
    for
      _ <- (listen +: joins.toSeq).find(!_.isLoopback && tls.isEmpty).toLeft(()).left.map(beyond =>
        s"expected certificates of both sides (--tls FOLDER) where ${beyond.host} is " +
          "of another machine, or reached by others; ./skein cluster certificates " +
          "FOLDER makes a lab's, and without them only 127.0.0.1 is used"
      )
      _ <- tls.fold(Right(()))(_.shows(listen.host))
    yield ConfigFactory
      .defaultOverrides()
      .withFallback(tls.fold(ConfigFactory.parseString(Plain))(_.config))
      .withFallback(ConfigFactory.parseString(common(listen)))
      .withFallback(ConfigFactory.load())

  /** The transport without certificates, on loopback only: nothing is encrypted. The engine passes bytes
    * through, and so can check the lengths of frames.
    */
  private val Plain = """
    pekko.remote.artery {
      transport = tls-tcp
      ssl.ssl-engine-provider = "skein.cluster.PlainEngines"
    }
  """

  private def common(listen: Address) = s"""
    pekko {
      loglevel = "ERROR"
      stdout-loglevel = "OFF"
      log-dead-letters = off
      log-dead-letters-during-shutdown = off
      actor {
        provider = cluster
        allow-java-serialization = off
        serializers.skein = "skein.cluster.MessageSerializer"
        serialization-bindings {
          "skein.cluster.Message" = skein
        }
      }
      remote {
        warn-about-direct-use = off
        artery {
          canonical.hostname = ${ConfigUtil.quoteString(listen.uriHost)}
          canonical.port = ${listen.port}
          # On a machine that has much else to do, 3 s are not enough.
          bind.bind-timeout = 30 s
          advanced {
            maximum-frame-size = $MostFrame b
            buffer-pool-size = 16
            outbound-message-queue-size = 8192
            inbound-lanes = 1
            outbound-lanes = 1
          }
        }
      }
      cluster {
        jmx.enabled = off
        log-info = off
        # A process is a member within a few of these.
        periodic-tasks-initial-delay = 50 ms
        gossip-interval = 100 ms
        leader-actions-interval = 100 ms
        seed-node-timeout = 3 s
        retry-unsuccessful-join-after = 1 s
        shutdown-after-unsuccessful-join-seed-nodes = 10 s
        failure-detector.acceptable-heartbeat-pause = 6 s
        # Of two halves the coordinator's goes on: it was first.
        downing-provider-class = "org.apache.pekko.cluster.sbr.SplitBrainResolverProvider"
        split-brain-resolver {
          active-strategy = keep-oldest
          stable-after = 7 s
          keep-oldest.down-if-alone = off
          # Else workers that are killed one after the other take the coordinator with them.
          down-all-when-unstable = off
        }
      }
      coordinated-shutdown {
        exit-jvm = off
        run-by-jvm-shutdown-hook = off
        phases.cluster-leave.timeout = 2 s
        phases.cluster-exiting.timeout = 2 s
        phases.cluster-exiting-done.timeout = 1 s
        phases.cluster-shutdown.timeout = 1 s
      }
    }
  """
