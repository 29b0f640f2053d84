use std::collections::HashSet;

use super::*;
use crate::contact::ContactLaw;
use crate::finger::FingerParams;
use crate::sensors::FluxParams;

fn layered() -> Params {
    Params { finger: FingerParams::layered(), ..Params::nominal() }
}

fn with_flux_sensor() -> Params {
    Params { flux: Some(FluxParams::NOMINAL), ..layered() }
}

/// All numbers in the debug output of the parameters.
fn numbers(params: &Params) -> Vec<f64> {
    format!("{params:?}")
        .split([' ', ',', '[', ']', '(', ')', '{', '}'])
        .filter_map(|word| word.parse().ok())
        .collect()
}

#[test]
fn every_field_has_exactly_one_parameter() {
    for params in [Params::nominal(), layered(), with_flux_sensor()] {
        let all = all(&params);
        assert_eq!(numbers(&params).len(), all.len());
        let keys: HashSet<_> = all.iter().map(|parameter| &parameter.key).collect();
        assert_eq!(keys.len(), all.len(), "keys repeat");
        // A distinct value set through each key appears once, and no field keeps its value.
        let mut marked = params.clone();
        for (i, entry) in entries(&mut marked).iter_mut().enumerate() {
            *entry.value = 1e6 + i as f64;
        }
        let marks: HashSet<_> = numbers(&marked).into_iter().map(f64::to_bits).collect();
        assert_eq!(marks.len(), all.len(), "two keys share a field");
        assert!(marks.iter().all(|bits| f64::from_bits(*bits) >= 1e6));
    }
}

#[test]
fn keys_reach_the_fields_they_name() {
    let params = with_flux_sensor();
    for parameter in all(&params) {
        let field = parameter.key.rsplit('.').next().expect("a name");
        let mut changed = params.clone();
        let value = if parameter.value.is_finite() && parameter.value * 1.5 <= parameter.most {
            parameter.value * 1.5 + 1e-9
        } else {
            parameter.most * 0.5 + parameter.least * 0.5
        };
        if !value.is_finite() {
            continue;
        }
        set(&mut changed, &parameter.key, value).unwrap_or_else(|error| panic!("{error}"));
        let [before, after] = [&params, &changed].map(|params| format!("{params:#?}"));
        let differing: Vec<_> = before
            .lines()
            .zip(after.lines())
            .filter(|(before, after)| before != after)
            .map(|(_, after)| after.trim().to_owned())
            .collect();
        let is_its_own =
            |line: &String| line.starts_with(&format!("{field}: ")) || field == "core_w_m2k";
        assert!(
            differing.len() == 1 && differing.iter().all(is_its_own),
            "{}: {differing:?}",
            parameter.key
        );
    }
}

#[test]
fn nominal_values_are_allowed_and_within_their_tolerance() {
    for params in [Params::nominal(), layered(), with_flux_sensor()] {
        for p in all(&params) {
            assert!(p.least <= p.low && p.low <= p.value, "{p:?}");
            assert!(p.value <= p.high && p.high <= p.most, "{p:?}");
            assert!(p.distribution != Distribution::Fixed || p.low == p.high, "{p:?}");
            assert!(!p.unit.is_empty() && p.meaning.len() > 3, "{p:?}");
        }
    }
}

#[test]
fn draws_follow_their_distribution_within_the_tolerance() {
    let nominal = with_flux_sensor();
    let limits = all(&nominal);
    const DRAWS: u64 = 2000;
    let drawn: Vec<Vec<f64>> = (0..DRAWS)
        .map(|seed| {
            let mut params = nominal.clone();
            draw(&mut params, seed);
            draw_contact(&mut params, seed);
            check(&params).unwrap_or_else(|error| panic!("seed {seed}: {error}"));
            all(&params).iter().map(|p| p.value).collect()
        })
        .collect();
    for (i, p) in limits.iter().enumerate() {
        let values = || drawn.iter().map(|draw| draw[i]);
        assert!(values().all(|value| (p.low..=p.high).contains(&value)), "{p:?}");
        if p.distribution == Distribution::Fixed || p.low == p.high {
            assert!(values().all(|value| value == p.value), "{p:?}");
            continue;
        }
        // Relative position between the limits, on the scale of the distribution.
        let place = |value: f64| match p.distribution {
            Distribution::LogUniform => (value / p.low).ln() / (p.high / p.low).ln(),
            _ => (value - p.low) / (p.high - p.low),
        };
        let mean = values().map(place).sum::<f64>() / DRAWS as f64;
        let variance = values().map(|v| (place(v) - mean).powi(2)).sum::<f64>() / DRAWS as f64;
        // Variance: uniform 1/12; normal truncated at two standard deviations 0.7737/16 (closed form).
        let exact = match p.distribution {
            Distribution::Normal => 0.773_741 / 16.0,
            _ => 1.0 / 12.0,
        };
        // Five standard errors of mean and variance (the latter bounded by the fourth moment of a uniform distribution).
        assert!((mean - 0.5).abs() < 5.0 * (exact / DRAWS as f64).sqrt(), "{}: mean {mean}", p.key);
        assert!(
            (variance / exact - 1.0).abs() < 5.0 * (2.0 / DRAWS as f64).sqrt(),
            "{}: {variance}",
            p.key
        );
    }
    // No two parameters, and no two seeds, share their draws.
    let first = |draw: &Vec<f64>| {
        let places = limits.iter().zip(draw);
        let free =
            places.filter(|(p, _)| p.distribution == Distribution::Uniform && p.low < p.high);
        free.map(|(p, v)| ((v - p.low) / (p.high - p.low) * 1e9) as u64).collect::<Vec<_>>()
    };
    let seen: Vec<u64> = drawn.iter().take(10).flat_map(first).collect();
    let different: HashSet<_> = seen.iter().collect();
    assert_eq!(different.len(), seen.len());
}

#[test]
fn draws_depend_on_seed_and_key_only() {
    let draw_of = |mut params: Params, seed| {
        draw(&mut params, seed);
        params
    };
    let mut contact = layered();
    draw_contact(&mut contact, 7);
    let contact = contact.contact;
    let nominal = ContactLaw::NOMINAL;
    assert_eq!(draw_of(layered(), 7).contact, nominal);
    assert!(contact.gap_w_m2k != nominal.gap_w_m2k && contact.exponent != nominal.exponent);
    assert_eq!(draw_of(layered(), 7), draw_of(layered(), 7));
    assert_ne!(draw_of(layered(), 7), draw_of(layered(), 8));
    // A finger of more layers does not change the other draws.
    let (few, many) = (draw_of(Params::nominal(), 7), draw_of(layered(), 7));
    assert_eq!((few.tile, few.bridge, few.sensors), (many.tile, many.bridge, many.sensors));
    assert_eq!((few.display, few.finger.surface), (many.display, many.finger.surface));
    assert_eq!(few.finger.air_w_m2k, 0.0, "no air film appears");
    // Nor does a heat-flux sensor.
    let fitted = Params { flux: None, ..draw_of(with_flux_sensor(), 7) };
    assert_eq!(many, fitted);
}

#[test]
fn unknown_keys_and_values_out_of_range_are_refused_without_change() {
    let mut params = Params::nominal();
    let message = |error: ParameterError| error.to_string();
    let typo = set(&mut params, "tile.imx_a", 5.0).map_err(message);
    let typo = typo.expect_err("no such key");
    assert!(
        typo.starts_with("no parameter is called tile.imx_a; similar are tile.imax_a, "),
        "{typo}"
    );
    for value in [0.0, f64::NAN, f64::INFINITY, -5.0] {
        let refused = set(&mut params, "tile.imax_a", value).map_err(message);
        assert_eq!(refused, Err(format!("tile.imax_a = {value} A; allowed is 0.5 to 30")));
    }
    assert_eq!(params, Params::nominal());
    assert_eq!(set(&mut params, "tile.imax_a", 5.5), Ok(()));
    assert_eq!(params.tile.imax_a, 5.5);
}
