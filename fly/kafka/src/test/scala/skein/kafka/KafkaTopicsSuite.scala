package skein.kafka

import skein.link.Address

class KafkaTopicsSuite extends munit.FunSuite:

  test("a broker's security settings apply to every client, keep the link's own settings, and are not shown"):
    val secret   = Map("security.protocol" -> "SSL", "ssl.truststore.password" -> "goose", "acks" -> "0")
    val topics   = KafkaTopics(Address("broker.lab", 9093), "skein")(secret)
    val settings = KafkaTopics.settings(topics)("acks" -> "1")
    assertEquals(settings.get("security.protocol"), "SSL")
    assertEquals(settings.get("ssl.truststore.password"), "goose")
    assertEquals(settings.get("acks"), "1")
    assertEquals(settings.get("bootstrap.servers"), "broker.lab:9093")
    assert(!topics.toString.contains("goose"), topics.toString)
